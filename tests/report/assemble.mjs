// Puts the page together without Rust, from the list of parts that src/report/mod.rs has.
// node assemble.mjs < data.json > report.html
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const ROOM = join(dirname(fileURLToPath(import.meta.url)), "../../src/report");

/** The files that the Rust side includes and whose names end so, in its order. */
function parts(ending) {
  const source = readFileSync(join(ROOM, "mod.rs"), "utf8");
  const names = [...source.matchAll(/include_str!\("([^"]+)"\)/g)].map((match) => match[1]);
  return names.filter((name) => name.endsWith(ending)).map((name) => readFileSync(join(ROOM, name), "utf8"));
}

/** The whole page for some JSON. */
export function page(json) {
  const [frame] = parts(".html");
  const fill = { "{{style}}": parts(".css").join(""), "{{data}}": json.replaceAll("<", "\\u003c"), "{{script}}": parts(".js").join("") };
  return frame.replace(/\{\{(style|data|script)\}\}/g, (mark) => fill[mark]);
}

if (import.meta.url === `file://${process.argv[1]}`) process.stdout.write(page(readFileSync(0, "utf8")));
