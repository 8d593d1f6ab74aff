// Which plots show what a figure or table of the paper shows.
import {$, element} from "../shared/dom.js";

const each = (presets, plots) => Object.fromEntries(presets.map((p) => [p, plots]));

const plotsOf = {
  fig3: ["x"],
  fig4: ["relative"],
  fig5: ["lambda", "raw_product"],
  fig6: ["J"],
  fig7: ["M"],
  fig8: ["T"],
  fig9: ["x", "largest"],
  ...each(["fig10", "fig11", "fig12", "fig13", "fig14"], ["relative", "lambda", "raw_product"]),
  ...each(["fig15", "fig16", "fig20", "fig21"], ["x"]),
  ...each(["fig17", "fig22"], ["portrait"]),
  ...each(["fig18", "fig23"], ["section"]),
  ...each(["fig19", "fig24", "table3"], ["lambda"]),
  table2: ["lambda", "windows"],
  ...each(["table1", "table4"], ["parameters"]),
};

/** Marks the plots that a preset is about, and says where one of them lies in the details. */
export function mark(preset) {
  for (const old of document.querySelectorAll("figure.about")) {
    old.classList.remove("about");
    old.querySelector(".tag").remove();
  }
  const names = plotsOf[preset?.name.split("_")[0]] ?? []; // the rows of a table show the same
  for (const name of names) {
    const figure = $(`figure-${name}`);
    const tag = element("span", {className: "tag", textContent: preset.source.split(",")[0]});
    figure.classList.add("about");
    figure.querySelector("figcaption").append(tag);
  }
  const below = names.find((name) => $(`figure-${name}`).closest("#details"));
  const alone = below && names.every((name) => $(`figure-${name}`).closest("#details"));
  $("to-details").href = alone ? `#figure-${below}` : "#details";
  $("to-details").textContent = alone ? `${preset.source.split(",")[0]} is below ▾` : "details ▾";
}
