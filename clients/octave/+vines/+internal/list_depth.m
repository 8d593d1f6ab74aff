function depth = list_depth(name)
  % Of a field of a request: 1 where it is a list, 2 where it is a list of lists, else 0. It tells
  % what one number, one word or one struct stands for.
  switch name
    case 'windows'
      depth = 2;
    case {'axes', 'exponents', 'fields', 'fixed', 'impact_times_s', 'include', 'indices', ...
          'starts', 'values', 'window'}
      depth = 1;
    otherwise
      depth = 0;
  end
end
