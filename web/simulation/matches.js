// Which plots show what a figure or table of the paper shows.
import {$, element, write} from "../shared/dom.js";

const plotsOf = {
  "fig3 fig16 fig21": ["x"],
  "fig15 fig20": ["acceleration"],
  fig4: ["relative"],
  fig5: ["lambda", "raw_product"],
  fig6: ["J"],
  fig7: ["M"],
  fig8: ["T"],
  fig9: ["x", "largest"],
  "fig10 fig11 fig12 fig13 fig14": ["relative", "lambda", "raw_product"],
  "fig17 fig22": ["portrait"],
  "fig18 fig23": ["section"],
  "fig19 fig24 table3": ["lambda"],
  table2: ["lambda", "windows"],
  "table1 table4": ["parameters"],
};

/** The names of the plots; the rows of a table show the same. */
function plotsFor(preset) {
  const figure = preset?.name.split("_")[0];
  const entries = Object.entries(plotsOf);
  return entries.find(([figures]) => figures.split(" ").includes(figure))?.[1] ?? [];
}

/** Marks the plots that a preset is about, and says where one of them lies in the details. */
export function mark(preset) {
  for (const old of document.querySelectorAll("figure.about")) {
    old.classList.remove("about");
    old.querySelector(".tag").remove();
  }
  const names = plotsFor(preset);
  const source = preset?.source.split(",")[0];
  const inDetails = (name) => $(`figure-${name}`).closest("#details");
  for (const name of names) {
    const figure = $(`figure-${name}`);
    figure.classList.add("about");
    figure
      .querySelector("figcaption")
      .append(element("span", {className: "tag", textContent: source}));
  }
  const alone = names.length && names.every(inDetails);
  $("to-details").href = alone ? `#figure-${names[0]}` : "#details";
  write({"to-details": alone ? `${source} is below ▾` : "details ▾"});
}
