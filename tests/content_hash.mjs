// The SHA-256 of an answer's content, computed as docs/api.md defines it.
import {createHash} from "node:crypto";

const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");
const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const holdsObject = (value) => isObject(value) || (Array.isArray(value) && value.some(holdsObject));

/** The bytes of a value without objects, in pieces. */
const form = (value) => {
  if (value === null) return ["n"];
  if (typeof value === "boolean") return [value ? "t" : "f"];
  if (typeof value === "string") return [JSON.stringify(value)];
  if (Array.isArray(value)) return ["[", ...value.flatMap(form), "]"];
  if (isObject(value)) return ["{}"];
  const bytes = Buffer.alloc(9, "d");
  bytes.writeDoubleLE(value + 0, 1);
  return [bytes];
};
const joined = (pieces) => Buffer.concat(pieces.map((piece) => Buffer.from(piece)));

function* entries(value, path) {
  if (isObject(value) ? Object.keys(value).length > 0 : holdsObject(value))
    for (const [name, part] of Object.entries(value)) yield* entries(part, `${path}/${name}`);
  else yield [path, Array.isArray(value) ? sha256(joined(form(value))) : joined(form(value))];
}

/** The hash of an answer without its provenance. */
export const contentHash = ({provenance, ...answer}) => {
  const all = [...entries(answer, "")].map(([path, bytes]) => [Buffer.from(path), bytes]);
  all.sort(([one], [other]) => Buffer.compare(one, other));
  return sha256(joined(all.flatMap(([path, bytes]) => [path, "=", bytes, "\n"])));
};
