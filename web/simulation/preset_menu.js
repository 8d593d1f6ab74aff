// Presets: figures and tables of the paper, some as chips, all in a menu; and the plots that
// correspond to them.
import {$, button, element, press, setTexts} from "../shared/dom.js";

const groups = {
  Regimes: {
    fig10: "I sparse",
    fig3: "II modulated",
    fig11: "III symmetric",
    fig12: "IV asymmetric",
    fig13: "V three impacts",
    fig14: "VI dense",
  },
  Exponents: {fig5: "Fig. 5", fig9: "Fig. 9", table2_1: "Table 2", "table3_b0.031": "Table 3"},
  Experiment: {fig15: "9 mm", fig20: "15 mm"},
};

/** choose(name) is called with the name of a preset; "" means user-defined parameters. */
export function start(presets, choose) {
  const sourceOf = Object.fromEntries(presets.map((p) => [p.name, `${p.source}: ${p.title}`]));
  const chip = ([name, text]) => {
    const one = button(text, () => choose(name), {className: "chip", title: sourceOf[name]});
    one.dataset.preset = name;
    return one;
  };
  const group = ([title, chips]) => {
    const names = Object.entries(chips).map(chip);
    const row = element("div", {role: "group", ariaLabel: title}, ...names);
    return element("div", {className: "chips"}, element("small", {textContent: title}), row);
  };
  $("chips").replaceChildren(...Object.entries(groups).map(group));
  $("preset").append(
    new Option("user-defined parameters", ""),
    ...presets.map((p) => new Option(sourceOf[p.name], p.name)),
  );
  $("preset").onchange = () => choose($("preset").value);
}

/** Selects the preset, and its chip unless the parameters were changed. */
export function markChip(name, changed) {
  $("preset").value = name;
  const is = (one) => one.dataset.preset === name && !changed;
  press(document.querySelectorAll("#chips button"), is);
}

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

/** Names of the plots of a preset; rows of a table share theirs. */
function plotsFor(preset) {
  const figure = preset?.name.split("_")[0];
  const entries = Object.entries(plotsOf);
  return entries.find(([figures]) => figures.split(" ").includes(figure))?.[1] ?? [];
}

/** Tags the plots of a preset, and links to one in the details if all of them are there. */
export function markPlots(preset) {
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
  setTexts({"to-details": alone ? `${source} is below ▾` : "details ▾"});
}
