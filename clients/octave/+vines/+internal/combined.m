function points = combined(list)
  % Struct array of a sweep's points, given as a cell array, sorted by index. Keys that only some
  % points have are [] in the others.
  if isempty(list)
    points = struct('index', {});
    return
  end
  [~, order] = sort(cellfun(@(point) point.index, list));
  list = list(order);
  names = fieldnames(list{1});
  if ~all(cellfun(@(point) isequal(fieldnames(point), names), list))
    every = cellfun(@fieldnames, list, 'UniformOutput', false);
    names = unique(vertcat(every{:}), 'stable');
    list = cellfun(@(point) filled(point, names), list, 'UniformOutput', false);
  end
  points = [list{:}];
end

function point = filled(point, names)
  for k = 1:numel(names)
    if ~isfield(point, names{k})
      point.(names{k}) = [];
    end
  end
  point = orderfields(point, names);
end
