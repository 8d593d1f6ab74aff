// Which plots show what a figure or table of the paper shows.
import {$, element} from "./dom.js";

const each = (presets, plots) => Object.fromEntries(presets.map((p) => [p, plots]));

const plotsOf = {
  fig3: ["x"],
  fig4: ["relative"],
  fig5: ["qr", "raw_product"],
  fig6: ["J"],
  fig7: ["M"],
  fig8: ["T"],
  fig9: ["x", "largest"],
  ...each(["fig10", "fig11", "fig12", "fig13", "fig14"], ["relative", "qr", "raw_product"]),
  ...each(["fig15", "fig16", "fig20", "fig21"], ["x"]),
  ...each(["fig17", "fig22"], ["portrait"]),
  ...each(["fig18", "fig23"], ["section"]),
  ...each(["fig19", "fig24"], ["qr"]),
  table2: ["qr", "windows"],
  table3: ["qr"],
};

const outside = (node) => {
  const {top, bottom} = node.getBoundingClientRect();
  return top < 0 || bottom > innerHeight;
};

/** Marks the plots that the preset is about; returns those that are on the page. */
export function mark(preset) {
  for (const old of document.querySelectorAll("figure.about")) {
    old.classList.remove("about");
    old.querySelector(".tag").remove();
  }
  const names = plotsOf[preset?.name.split("_")[0]] ?? []; // the rows of a table show the same
  const figures = names.map((name) => $(`figure-${name}`)).filter((figure) => !figure.hidden);
  for (const figure of figures) {
    const tag = element("span", {className: "tag", textContent: preset.source.split(",")[0]});
    figure.classList.add("about");
    figure.querySelector("figcaption").prepend(tag);
  }
  return figures;
}

/** Leads the eye to the marked plots, if they are not in view already. */
export function show(figures) {
  for (const figure of figures) figure.closest("details").open = true;
  if (!figures.some(outside)) return;
  const behavior = matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth";
  figures[0].scrollIntoView({block: "start", behavior});
}
