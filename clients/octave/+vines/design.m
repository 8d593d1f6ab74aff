function [done, points, samples] = design(varargin)
  % [DONE, POINTS, SAMPLES] = vines.design(NAME, VALUE, ...)
  %
  % Searches the best absorber over a band. For the fields, in pairs or in a struct, see docs/api.md:
  %
  %   machine = struct('m1', 2, 'f0', 8, 'damping_ratio', 0.01, 'm2', 0.04);
  %   done = vines.design('base', machine, 'f', [7 9], 'acceleration', 5);
  %   plot(done.response.f, [done.response.x_max_worst_start done.response.without])
  %
  % POINTS and SAMPLES are arrays of structs: the absorbers tried, and the samples of the tolerances,
  % in the order of the computation.
  %
  % Errors: those of vines.simulate, and vines:incomplete if the computation ended early.
  given = vines.internal.fields(varargin);
  request = struct('route', 'design', 'body', vines.internal.json(given));
  lines = vines.internal.completed_lines(request);
  done = lines{end};
  points = vines.internal.of_type(lines, 'point');
  samples = vines.internal.of_type(lines, 'sample');
end
