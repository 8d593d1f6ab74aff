// A client in TypeScript that reads responses without a cast.
import type {components} from "./vines";

type Schemas = components["schemas"];

export const timesOf = (run: Schemas["Simulation"]): number[] => run.impacts?.tau ?? [];

export const largestOf = (line: Schemas["SweepLine"]): number | null | undefined =>
  line.type === "point" && Array.isArray(line.lambda)
    ? line.lambda[0]
    : undefined;

export const errorsOf = (problem: Schemas["Problem"]): string[] =>
  (problem.errors ?? []).map((error) => `${error.pointer}: ${error.detail}`);
