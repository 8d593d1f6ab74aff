function [points, info, last] = points_of(route, arguments)
  % Points of a request to ROUTE, 'sweep' or 'basins', as from follow_sweep.m. ARGUMENTS are the
  % fields, after a function to be called with each point, if any.
  each = [];
  if ~isempty(arguments) && isa(arguments{1}, 'function_handle')
    each = arguments{1};
    arguments(1) = [];
  end
  given = vines.internal.fields(arguments);
  indices = [];
  if isfield(given, 'indices')
    indices = given.indices;
    if iscell(indices)
      indices = cell2mat(indices);
    end
  end
  request = struct('route', route, 'body', vines.internal.json(given));
  [points, info, last] = vines.internal.follow_sweep(request, each, indices(:)');
end
