# Sourced by the browser checks: finds Node.js and Chromium as `node` (a command with its flags) and `browser`.
# Installs nothing, and says what is missing.
missing() {
    printf '%s: %s\n' "$0" "$*" >&2
    exit 69
}

command -v node >/dev/null || missing "node is missing: install Node.js 20.10 or later"
node=(node)
if ! node -e 'process.exit(typeof WebSocket === "function" ? 0 : 1)'; then
    node --experimental-websocket -e '' 2>/dev/null || missing "this node has no WebSocket: install Node.js 20.10 or later"
    node=(node --experimental-websocket --no-warnings)
fi

browser=${CHROMIUM:-}
for name in chromium chromium-browser google-chrome google-chrome-stable; do
    [ -n "$browser" ] || browser=$(command -v "$name" || true)
done
[ -n "$browser" ] || missing "no Chromium: install the package chromium, or name one with CHROMIUM=PATH"
