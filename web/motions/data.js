// The motions over a parameter: those that the system settles on, and branches of periodic orbits.

const near = 2e-3; // relative difference of |x| within which a motion lies on a branch

const isNear = (a, b) => Math.abs(a - b) < near * Math.abs(b);
const isSame = (one, other) => isNear(one.x_max, other.x_max) && isNear(one.x_rms, other.x_rms);

export class Motions {
  attractors = []; // {value, x_max, x_rms, z, regime, verdict, state}
  branches = []; // lists of orbits {value, stable, x_max, ..., state}
  specials = []; // {kind, value, branch, detail, ...}
  tried = new Set(); // attractors from which a continuation started

  /** request: {base, parameter, from, to}; preset: parameters of the base's preset, if any. */
  constructor(request, preset) {
    this.request = request;
    const {base, parameter, from, to} = request;
    const given = base[parameter] ?? preset?.[parameter];
    const [least, most] = [Math.min(from, to), Math.max(from, to)];
    /** Value of the parameter from which the first continuation starts. */
    this.start = given >= least && given <= most ? given : (from + to) / 2;
  }

  /** Takes a line of a sweep from several starts. */
  settled({type, axes, starts, index}) {
    if (type === "start") this.values = axes[0].values;
    if (type !== "point" || !starts) return;
    const value = this.values[index];
    for (const motion of starts) if (motion.x_max != null) this.attractors.push({...motion, value});
  }

  /** Takes a line; offset: number of earlier branches. Returns false if it begins on one. */
  continued({type, branch, ...orbit}, offset) {
    const value = orbit[this.request.parameter];
    const number = branch == null ? null : branch + offset;
    const begins = type === "point" && number === offset && !this.branches[number].length;
    if (begins && this.at(value).some((known) => isSame(known, orbit))) {
      this.branches.length = offset;
      return false;
    }
    if (type === "branch") this.branches[number] ??= [];
    else if (type === "point") this.branches[number].push({...orbit, value});
    else if (type === "special") this.specials.push({...orbit, value, branch: number});
    return true;
  }

  /** The orbits of all branches at a value, from their neighbours by linear interpolation. */
  at(value) {
    return this.branches.flatMap((branch) =>
      branch.slice(1).flatMap((next, i) => {
        const last = branch[i];
        const share = (value - last.value) / (next.value - last.value);
        if (!(share >= 0 && share <= 1)) return [];
        const closest = share < 0.5 ? last : next;
        const between = (name) => last[name] + share * (next[name] - last[name]);
        return [{...closest, x_max: between("x_max"), x_rms: between("x_rms")}];
      }),
    );
  }

  /** The different ones among them: continuations from several starts can meet. */
  distinctAt(value) {
    const isFirst = (one, i, all) => all.findIndex((other) => isSame(one, other)) === i;
    return this.at(value).filter(isFirst);
  }

  /** A regular motion with impacts that lies on no branch, a new one each time; undefined without. */
  unexplained() {
    const isKnown = (motion) => this.at(motion.value).some((orbit) => isSame(orbit, motion));
    // Neighbours of a motion that could not be continued are of its kind.
    const isTried = ({value, x_max: x}) =>
      [...this.tried].some((one) => one.value === value || isNear(one.x_max, x));
    const found = this.attractors.find(
      (motion) => motion.verdict === "regular" && motion.z && !isTried(motion) && !isKnown(motion),
    );
    if (found) this.tried.add(found);
    return found;
  }
}
