function done = design(varargin)
  % DONE = vines.design(NAME, VALUE, ...)
  %
  % Searches the best absorber over a band. For the fields, in pairs or in a struct, see docs/api.md:
  %
  %   machine = struct('m1', 2, 'f0', 8, 'damping_ratio', 0.01, 'm2', 0.04);
  %   done = vines.design('base', machine, 'f', [7 9], 'acceleration', 5);
  %   plot(done.response.f, [done.response.x_max_worst_start done.response.without])
  %
  % Errors: those of vines.simulate, and vines:incomplete if the computation ended early.
  given = vines.internal.fields(varargin);
  request = struct('route', 'design', 'body', vines.internal.json(given));
  lines = vines.internal.completed_lines(request);
  done = lines{end};
end
