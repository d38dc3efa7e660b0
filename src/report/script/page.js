// Fills the page, section by section.

/** Takes away the links to sections that have nothing to show. */
function hideDeadLinks() {
  for (const link of document.querySelectorAll("nav a")) link.hidden = document.querySelector(link.hash).hidden;
}

/** Escape closes what is open over the page. */
function closeWithEscape() {
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    hideTip();
    for (const menu of document.querySelectorAll("details.columns[open]")) menu.open = false;
  });
  addEventListener("pointerdown", (event) => {
    for (const menu of document.querySelectorAll("details.columns[open]")) if (!menu.contains(event.target)) menu.open = false;
  });
}

fillTheme();
fillHeader();
fillFindings();
fillRegions();
fillAxes();
fillFacts();
fillNotes();
fillConvergence();
fillBars();
fillGroups();
fillViewer();
fillMaps();
fillRuns();
hideDeadLinks();
closeWithEscape();
drawForPaper();
changed();
