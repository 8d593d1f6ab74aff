function [points, course] = sweep(varargin)
  % POINTS = vines.sweep(NAME, VALUE, ...)
  % POINTS = vines.sweep(EACH, NAME, VALUE, ...)
  % [POINTS, COURSE] = vines.sweep(...)
  %
  % The same over one to three parameters. Fields are those of docs/api.md, in pairs or in a struct:
  %
  %   axis = struct('parameter', 'b', 'from', 0.01, 'to', 0.05, 'count', 41);
  %   points = vines.sweep('axes', axis);
  %   plot([points.b], [points.x_rms_ratio])
  %
  % POINTS is an array of structs in the order of their index. Where some lack a key it is [] there.
  %
  % EACH is called as EACH(POINT, COURSE) with each point as it comes, from a service coarse to fine
  % over the axes. An error in it, or Ctrl-C, ends the computing.
  %
  % COURSE has done and total, the points that came and that were asked for; missing, the indices of
  % the others; start, the sweep's first line; progress, a service's latest word; warnings.
  %
  % Errors: those of vines.simulate, and vines:incomplete where not all points came. vines.problem()
  % has those that did in points then, and missing: ask for the rest by 'indices', missing.
  each = [];
  if nargin > 0 && isa(varargin{1}, 'function_handle')
    each = varargin{1};
    varargin(1) = [];
  end
  given = vines.internal.fields(varargin);
  indices = [];
  if isfield(given, 'indices')
    indices = given.indices;
    if iscell(indices)
      indices = cell2mat(indices);
    end
  end
  request = struct('route', 'sweep', 'body', vines.internal.json(given));
  [points, course] = vines.internal.follow(request, each, indices(:)');
end
