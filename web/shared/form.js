// A form built from a field table of /v1/parameters; the placeholder shows the default of a field.
import {element} from "./dom.js";
import {toNumber} from "./numbers.js";
import {symbolOf} from "./quantities.js";
import {unitShown} from "./units.js";

// Groups of /v1/simulate: title, whether it is open at first, note.
export const groups = {
  system: ["System", true],
  reduced: ["Reduced parameters", false],
  SI: [
    "SI parameters",
    false,
    "A user-defined system: m1, F and f, and one field of each pair in between.",
  ],
  laws: ["Laws of ball and walls", false],
  load: ["Load instead of F and f", false],
  start: ["Initial state", false],
  run: ["Run", true],
  output: ["Output", false],
};
const {system, reduced, SI, laws, load, start} = groups;
const ofSystem = {system, reduced, SI, laws, start};
/** True for fields of /v1/parameters that affect the motion. */
export const isOfMotion = (field) =>
  field?.group in {...ofSystem, load} || ["tau_end", "cycles"].includes(field?.name);

// The page chooses `include`, and has a menu outside the form for a preset without choices.
const hidden = new Set(["include", "perturbation"]);
const isShown = ({name, choices}) => !hidden.has(name) && (name !== "preset" || choices);

/** Pairs of SI fields of one quantity; the origin of the second shows if the first was given. */
const equivalents = {
  f0: "k1",
  damping_ratio: "c1",
  mass_ratio: "m2",
  acceleration: "F",
  inclination: "gravity",
  mu: "friction",
  x_velocity0: "x_dot0",
  y_velocity0: "y_dot0",
};

function originOfEquivalent(name, origin) {
  const other = equivalents[name];
  const text = origin[other] ?? "";
  if (text.startsWith(`follows from ${name}`)) return "given";
  if (text === "default") return text;
  return `follows from ${other}${name === "f0" || name === "mass_ratio" ? ", m1" : ""}`;
}

const standardGravity = 9.80665; // m/s^2

/** {inclination, mu} of a system in SI from its gravity and friction; null without such an angle. */
export function lawsInSi({gravity = 0, friction = 0, derived: {omega0}}) {
  const sine = (gravity * omega0 ** 2) / standardGravity;
  const inclination = Math.abs(sine) <= 1 ? Math.asin(sine) : null;
  const mu = friction && (friction * omega0 ** 2) / (standardGravity * Math.cos(inclination));
  return {inclination, mu: inclination === null ? null : mu};
}

/** {values, origins} by field name, from `parameters` of an answer. */
export function resolved({si, derived = {}, origin = {}, ...own}) {
  const values = {...own, ...si, ...(si && lawsInSi({...own, derived}))};
  const origins = {...origin};
  if (own.R_plus === own.R_minus && origin.R_plus === origin.R_minus)
    [values.R, origins.R] = [own.R_plus, origin.R_plus];
  if (si) {
    for (const name of ["f0", "damping_ratio", "mass_ratio"]) values[name] = derived[name];
    for (const name of Object.keys(equivalents)) origins[name] = originOfEquivalent(name, origin);
  }
  return {values, origins};
}

/** Short text for the form; empty for given values. */
function originText(origin) {
  if (!origin || origin === "given") return "";
  return origin
    .replace(/^preset /, "")
    .replace(/^follows from/, "from")
    .replace(/^swept:.*/, "swept");
}

export const isObject = (value) => typeof value === "object" && value !== null;

const longest = 24; // entries of a list that an input shows

/** The text that an input shows for a value. */
export function textOf(value, most = longest) {
  if (Array.isArray(value) && value.length > most) return `${value.length} values`;
  const text = (part) => textOf(part, most);
  if (Array.isArray(value)) return value.map(text).join(isObject(value[0]) ? "; " : ", ");
  if (!isObject(value)) return String(value);
  const parts = Object.entries(value).map(([name, part]) => `${name}=${text(part)}`);
  return parts.join(Object.values(value).some(Array.isArray) ? "; " : ", ");
}

const longestInAddress = 1500; // characters of a value; servers accept addresses of about 8 kB

/** A value as text of an address; undefined for one that is too long. */
function queryText(value) {
  const isPlain = !isObject(value) || Array.isArray(value);
  const text = isPlain ? textOf(value, Infinity).replace(/([,;]) /g, "$1") : JSON.stringify(value);
  return text.length > longestInAddress ? undefined : text;
}

/** Fields as a query, without values that are too long for an address. */
export const queryOf = (fields) => {
  const texts = Object.entries(fields).map(([name, value]) => [name, queryText(value)]);
  return String(new URLSearchParams(texts.filter(([, text]) => text !== undefined)));
};

/** The value of a text that queryText() made of an object; any other value is returned unchanged. */
function fromQuery(value) {
  if (typeof value !== "string" || !value.startsWith("{")) return value;
  try {
    return JSON.parse(value);
  } catch {
    return value;
  }
}

/** Message about unknown names in the address. */
export const unknownText = (names) =>
  names.length ? `unknown names in the address: ${names.map((n) => `"${n}"`).join(", ")}` : "";

/** A text as a JSON value. Text that is no number is sent unchanged, and the service rejects it. */
const number = (text) => toNumber(text) ?? text.trim();
const interval = (text) => text.split(text.includes(";") ? ";" : ",").map(number);
const partsOf = (text) => text.split(";").filter((part) => part.trim());
/** An object whose parts can be lists: speed_m_s=0, 0.5; R=0.8, 0.6. */
const object = (text) =>
  text.includes("=")
    ? Object.fromEntries(
        text.split(text.includes(";") ? ";" : /,(?=[^,]*=)/).map((part) => {
          const [name, list = ""] = part.split("=");
          return [name.trim(), list.includes(",") ? interval(list) : number(list)];
        }),
      )
    : text.trim();
export const defaultSet = "default set"; // value of `starts` in place of a list

/** The first entry of a menu whose default depends on other fields; shows the service's choice. */
const automatic = ({group, default: standard}) =>
  group === "system" ? [new Option(`automatic: ${standard ?? "none"}`, "")] : [];

/** A value in the unit shown; anything but a number is returned unchanged. */
export const shown = ({factor}, value) => times(value, factor);

/** What an empty input stands for, before the first answer. */
function placeholderOf(field) {
  const note = (field.default_note ?? "").split(":")[0];
  return note || textOf(shown(field, field.default ?? "")) || typeOf(field).hint || "";
}

/** A type whose input is a text; field.exact keeps a value whose text is shorter. */
const typed = (read, hint) => ({
  read,
  hint,
  make: (field) =>
    element("input", {
      type: "text",
      inputMode: read === number ? "decimal" : "text",
      placeholder: placeholderOf(field),
    }),
  get({input: {value: text}, exact, factor}) {
    if (!text.trim()) return undefined;
    return exact.text === text ? exact.value : times(read(text), 1 / factor);
  },
  set(field, given) {
    const value = given ?? "";
    const text = textOf(shown(field, value));
    field.input.value = text;
    field.exact = {text, value: typeof value === "string" ? read(value) : value};
  },
  suggest({input}, text) {
    input.placeholder = text;
  },
});

// Types of fields: make(field) creates the input, get(field) returns its value, undefined for the
// default, set(field, value) sets it, suggest(field, text) shows the default; hint: without one.
const types = {
  choice: {
    make: (field) =>
      element("select", {}, ...automatic(field), ...field.choices.map((c) => new Option(c))),
    get: ({input: {value, options}, default: standard}) =>
      value === (options[0].value && standard) ? undefined : value,
    set({input, default: standard}, value) {
      input.value = value ?? (input.options[0].value && standard);
    },
    suggest({input: {options}}, text) {
      if (options[0].value === "") options[0].text = `automatic: ${text}`;
    },
  },
  choices: {
    make({choices, name}) {
      const boxOf = (value) => element("input", {type: "checkbox", value});
      const labels = choices.map((c) => element("label", {}, boxOf(c), c));
      const about = {className: "checks line", role: "group", ariaLabel: name};
      return element("div", about, ...labels);
    },
    get({input, default: standard}) {
      const chosen = [...input.querySelectorAll("input:checked")].map((box) => box.value);
      return chosen.length === standard.length ? undefined : chosen;
    },
    set({input, default: standard}, chosen) {
      for (const box of input.querySelectorAll("input"))
        box.checked = String(chosen ?? standard)
          .split(",")
          .includes(box.value);
    },
  },
  number: typed(number),
  interval: typed(interval),
  numbers: typed(interval),
  intervals: typed((text) => partsOf(text).map(interval), "none; e.g. 0,500; 500,1000"),
  states: typed(
    (text) => (text.trim() === defaultSet ? defaultSet : partsOf(text).map(object)),
    "one; e.g. x0=0.01; x0=0, y0=0.002",
  ),
  object: typed(object),
  text: typed((text) => text.trim()),
};
const typeOf = ({type}) => types[type] ?? types.number;

// Pairs of fields that express the same quantity: when one is filled, the other follows from it.
const pairs = Object.entries({...equivalents, cycles: "tau_end"});
const others = Object.fromEntries([...pairs, ...pairs.map((pair) => pair.toReversed())]);
const excludes = {SI: "reduced", reduced: "SI"}; // a system is given in one of them

/** A number, or each one of a list, to six digits; anything else is returned unchanged. */
export function rounded(value) {
  if (Array.isArray(value)) return value.map(rounded);
  return typeof value === "number" ? Number(value.toPrecision(6)) : value;
}

const factorOf = ({unit, type}) => (type === "number" ? unitShown(unit).factor : 1);

/** A number times a factor, without rounding digits; anything else is returned unchanged. */
const times = (value, factor) =>
  factor === 1 || value === "" || !Number.isFinite(Number(value))
    ? value
    : Number((value * factor).toPrecision(15));

/** Shows an origin; without one the value is not that of the last answer. */
function showOrigin({origin}, title = "") {
  Object.assign(origin, {textContent: originText(title), title});
}

function setField(field, value) {
  typeOf(field).set(field, value);
  showOrigin(field);
}

/** On a small screen the groups are closed at first, because the results lie below them. */
export const smallScreen = matchMedia("(width < 62rem)").matches;

export class Form {
  parts = new Map(); // <details> of the groups
  replaced = [];

  /**
   * prefix: of ids; grouped: the groups to show. `fields` holds the shown ones, whose `label`
   * replaces their name, each with its factor and its elements: row, input, origin, error.
   */
  constructor(container, fields, {prefix = "", grouped = groups} = {}) {
    this.prefix = prefix;
    this.fields = fields
      .filter((f) => isShown(f) && f.group in grouped)
      .map((f) => ({...f, factor: factorOf(f)}));
    this.named = new Map(this.fields.map((field) => [field.name, field]));
    for (const [group, [title, open, note = ""]] of Object.entries(grouped)) {
      const rows = this.fields.filter((f) => f.group === group).map((f) => this.row(f));
      const details = element(
        "details",
        {open: open && !smallScreen, id: `${prefix}group-${group}`},
        element("summary", {}, title),
        element("p", {className: "note"}, note),
        element("div", {className: "grid"}, ...rows),
      );
      this.parts.set(group, details);
      container.append(details);
    }
    container.addEventListener("input", () => this.updateDisabled());
  }

  row(field) {
    const {name, label: title = name, type, minimum, maximum} = field;
    const {make, set, read} = typeOf(field);
    const input = make(field);
    const error = element("p", {className: "error", id: `${this.prefix}error-${name}`});
    const origin = element("span", {className: "origin"});
    input.setAttribute("aria-describedby", error.id);
    input.addEventListener("input", () => showOrigin(field));
    const {unit: own, factor} = unitShown(field.unit);
    const unit = factor === field.factor ? own : field.unit;
    const shownUnit = element("span", {className: "unit"}, unit && `, ${unit}`);
    const named = element("span", {}, symbolOf(title).replaceAll("_", " "), shownUnit);
    const [least, most] = [minimum, maximum].map((v) => shown(field, v));
    const range = minimum === undefined ? "" : ` [${least} to ${most}]`;
    const label = element(
      type === "choices" ? "div" : "label",
      {title: `${title}: ${field.description}${range}`},
      element("span", {className: "name"}, named, origin),
      input,
    );
    const width = field.narrow || [number, interval].includes(read) ? "" : " wide";
    const row = element("div", {className: `field field-${name}${width}`}, label, error);
    Object.assign(field, {row, input, origin, error});
    set(field);
    return row;
  }

  input(name) {
    return this.named.get(name).input;
  }

  /** Fields that differ from their defaults, for JSON. */
  values() {
    const given = this.fields.filter(({input}) => !input.disabled);
    const values = given.map((field) => [field.name, typeOf(field).get(field)]);
    return Object.fromEntries(values.filter(([, value]) => value !== undefined));
  }

  /** The values by their part of the request. */
  parted() {
    const values = this.values();
    const parts = {base: {}};
    for (const {name, label = name, part} of this.fields)
      if (name in values) parts[part] = {...parts[part], [label]: values[name]};
    return parts;
  }

  /** The values of texts by the names of fields, for JSON. */
  parse(texts) {
    const value = ([name, text]) => {
      const known = fromQuery(text);
      const {read} = typeOf(this.named.get(name) ?? {});
      return [name, known === text && read ? read(text) : known];
    };
    return Object.fromEntries(Object.entries(texts).map(value));
  }

  set(values) {
    for (const field of this.fields) setField(field, fromQuery(values[field.name]));
    this.unfold(values);
    this.updateDisabled();
    this.showErrors([]);
  }

  /** Opens the groups of the given values; on a small screen they stay closed. */
  unfold(values) {
    for (const {name, group} of smallScreen ? [] : this.fields)
      if (values[name] !== undefined) this.parts.get(group).open = true;
  }

  /** Shows the origins in `parameters` of an answer, its values as placeholders of empty inputs. */
  showOrigins(parameters) {
    const {values, origins} = resolved(parameters);
    for (const field of this.fields) {
      const {[field.name]: value} = values;
      showOrigin(field, origins[field.name]);
      const text = value == null ? placeholderOf(field) : textOf(rounded(shown(field, value)));
      typeOf(field).suggest?.(field, text);
    }
  }

  /** Disables exactly the fields that are set elsewhere. */
  disable(names) {
    this.replaced = names;
    this.updateDisabled();
  }

  /** Sets a value and clears its origin. */
  replace(name, value) {
    setField(this.named.get(name), value);
    this.updateDisabled();
  }

  /** The names among those of `fields` that the form does not have. */
  unknown(fields) {
    return Object.keys(fields).filter((name) => !this.named.has(name));
  }

  filled(name) {
    return Boolean(this.named.get(name)?.input.value?.trim());
  }

  /** Disables fields that are set elsewhere, follow from another field or cannot be combined. */
  updateDisabled() {
    const isGiven = ({name}) => this.filled(name) || this.replaced.includes(name);
    const given = this.fields.filter(isGiven).map(({group}) => group);
    for (const {name, group, input} of this.fields) {
      const other = others[name];
      const isExcluded = given.includes(excludes[group]) && !given.includes(group);
      const follows = !this.filled(name) && (this.filled(other) || isExcluded);
      input.disabled = follows || [name, other].some((each) => this.replaced.includes(each));
    }
  }

  /** The field of an error, also in the base or the only axis; of an axis its end with the value. */
  nameOf({pointer, value}) {
    if (pointer === "/axes/0") return ["from", "to"].find((end) => this.values()[end] === value);
    return pointer.replace(/^\/(base|axes\/0)(?=\/)/, "").split("/")[1];
  }

  /** Shows errors at their fields, focuses the first if `lead`; returns those without a field. */
  showErrors(errors, lead = true) {
    for (const {input, error} of this.fields) {
      error.textContent = "";
      input.removeAttribute("aria-invalid");
    }
    const fieldOf = (error) => this.named.get(this.nameOf(error));
    for (const error of errors.filter(fieldOf)) {
      const {input, error: place} = fieldOf(error);
      place.append(place.textContent && " ", error.detail);
      input.setAttribute("aria-invalid", "true");
      // The groups of the form lie in a further fold, which only an error that leads opens.
      for (let at = input.closest("details"); at; at = lead && at.parentElement.closest("details"))
        at.open = true;
    }
    if (lead) this.fields.find(({error}) => error.textContent)?.input.focus();
    return errors.filter((error) => !fieldOf(error));
  }
}

/** A form with the fields of a system, the `base` of its request, and of parameters that vary. */
export class BaseForm extends Form {
  /**
   * grouped: the groups above those of the system; own(names): their fields, each with its `part`
   * of the request; names: of the parameters that can vary.
   */
  constructor(container, {fields, presets}, prefix, grouped, own) {
    const choices = presets.map(({name}) => name);
    const shared = fields
      .filter(({group}) => group in ofSystem)
      .map((f) => ({...f, part: "base", ...(f.name === "preset" && {choices})}));
    const parameters = new Map(shared.filter((f) => f.type === "number").map((f) => [f.name, f]));
    const all = [...own([...parameters.keys()]), ...shared];
    super(container, all, {prefix, grouped: {...grouped, ...ofSystem}});
    this.parameters = parameters;
  }

  /** Sets the unit in which the ends of a range are typed to that of the parameter. */
  scale(ends, parameter) {
    const {factor} = unitShown(this.parameters.get(parameter)?.unit);
    for (const name of ends) this.named.get(name).factor = factor;
  }
}
