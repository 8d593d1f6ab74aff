function points = together(list)
  % A cell array of a sweep's points as an array of structs, by their index. Some may have keys that
  % others lack: [] there.
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
