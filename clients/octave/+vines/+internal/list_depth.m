function depth = list_depth(name)
  % Depth of a request field: 1 for a list, 2 for a list of lists, else 0. A single value of a list
  % field is sent as a list with one element; in forcing and restitution it is given as a cell: {8}.
  switch name
    case 'windows'
      depth = 2;
    case {'axes', 'exponents', 'fields', 'fit', 'fixed', 'impact_times_s', 'include', 'indices', ...
          'starts', 'values', 'window'}
      depth = 1;
    otherwise
      depth = 0;
  end
end
