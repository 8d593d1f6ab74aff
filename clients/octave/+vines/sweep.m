function [points, info] = sweep(varargin)
  % POINTS = vines.sweep(NAME, VALUE, ...)
  % POINTS = vines.sweep(EACH, NAME, VALUE, ...)
  % [POINTS, INFO] = vines.sweep(...)
  %
  % Simulates runs over one to three parameters. For the fields, in pairs or in a struct, see
  % docs/api.md:
  %
  %   axis = struct('parameter', 'b', 'from', 0.01, 'to', 0.05, 'count', 41);
  %   points = vines.sweep('axes', axis);
  %   plot([points.b], [points.x_rms_ratio])
  %
  % POINTS is an array of structs in the order of their index. A key that a point lacks is [].
  %
  % EACH is called as EACH(POINT, INFO) with each point as it arrives; a service sends the points
  % from coarse to fine over the axes. An error in EACH, or Ctrl-C, stops the computation.
  %
  % INFO has done and total, the numbers of points received and requested; missing, the indices of
  % the others; start, the sweep's first line; progress, the service's latest progress report;
  % warnings.
  %
  % Errors: those of vines.simulate, and vines:incomplete if points are missing. vines.problem()
  % then has the received ones in points, and missing: request the rest with 'indices', missing.
  [points, info] = vines.internal.points_of('sweep', varargin);
end
