// What one can start from: figures and tables of the paper, a handful of them as chips, all in a
// menu.
import {$, button, element, press} from "../shared/dom.js";

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

/** choose(name): called with the name of a preset, or "" for parameters of one's own. */
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
    new Option("parameters of your own", ""),
    ...presets.map((p) => new Option(sourceOf[p.name], p.name)),
  );
  $("preset").onchange = () => choose($("preset").value);
}

/** Marks the preset that the form stands on, and its chip unless it is changed. */
export function mark(name, changed) {
  $("preset").value = name;
  const is = (one) => one.dataset.preset === name && !changed;
  press(document.querySelectorAll("#chips button"), is);
}
