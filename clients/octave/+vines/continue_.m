function [points, specials, branches] = continue_(varargin)
  % [POINTS, SPECIALS, BRANCHES] = vines.continue_(NAME, VALUE, ...)
  %
  % Follows periodic orbits along a parameter. For the fields, in pairs or in a struct, see
  % docs/api.md:
  %
  %   base = struct('b', 0.015, 'damping', 'closed_form');
  %   [points, specials] = vines.continue_('base', base, 'parameter', 'b', 'from', 0.005, ...
  %                                        'to', 0.02, 'switch', 1);
  %   plot([points.b], [points.x_max], '.')
  %
  % POINTS, SPECIALS and BRANCHES are arrays of structs, in the order of the computation. A key that
  % only some of them have is [] in the others.
  %
  % Errors: those of vines.simulate, and vines:incomplete if the computation ended early.
  given = vines.internal.fields(varargin);
  request = struct('route', 'continue', 'body', vines.internal.json(given));
  lines = vines.internal.completed_lines(request);
  points = vines.internal.of_type(lines, 'point');
  specials = vines.internal.of_type(lines, 'special');
  branches = vines.internal.of_type(lines, 'branch');
end
