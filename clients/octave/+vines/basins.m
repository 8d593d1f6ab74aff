function [points, result] = basins(varargin)
  % [POINTS, RESULT] = vines.basins(NAME, VALUE, ...)
  %
  % Finds the motions to which starts in a box lead. For the fields, in pairs or in a struct, see
  % docs/api.md:
  %
  %   base = struct('b', 0.0065, 'damping', 'closed_form', 'y0', 0);
  %   box = struct('x0', [-0.003 0.003], 'y_dot0', [-0.02 0.02]);
  %   [points, result] = vines.basins('base', base, 'box', box, 'count', 1000);
  %   {result.attractors.attractor}, [result.attractors.fraction]
  %
  % POINTS is an array of structs, one for each start in the order of its index; RESULT has the
  % arrays ATTRACTORS, the motions with their basins, and BASINS, the statistics of the boundaries.
  % A function as first argument and errors: as those of vines.sweep.
  [points, ~, result] = vines.internal.points_of('basins', varargin);
end
