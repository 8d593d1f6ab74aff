// The SHA-256 of an answer's content, computed as docs/api.md defines it.
import {createHash} from "node:crypto";

const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");
const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const holdsObject = (value) => isObject(value) || (Array.isArray(value) && value.some(holdsObject));

/** The form of a value, in pieces. */
const form = (value, isInList = false) => {
  if (value === null) return ["n"];
  if (typeof value === "boolean") return [value ? "t" : "f"];
  if (typeof value === "string") return [JSON.stringify(value)];
  if (typeof value === "number") {
    const bytes = Buffer.alloc(9, "d");
    bytes.writeDoubleLE(value + 0, 1);
    return [bytes];
  }
  if (isObject(value)) {
    const names = Object.keys(value).sort((a, b) => Buffer.compare(Buffer.from(a), Buffer.from(b)));
    return ["{", ...names.flatMap((name) => [form(name), form(value[name])].flat()), "}"];
  }
  const hashed = !isInList && !holdsObject(value);
  const pieces = ["[", ...value.flatMap((entry) => form(entry, !holdsObject(value))), "]"];
  const bytes = joined(pieces);
  return hashed && bytes.length > 64 ? [sha256(bytes)] : [bytes];
};
const joined = (pieces) => Buffer.concat(pieces.map((piece) => Buffer.from(piece)));

/** The hash of an answer without its provenance. */
export const contentHash = ({provenance, ...answer}) => sha256(joined(form(answer)));
