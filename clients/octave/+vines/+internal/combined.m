function lines = combined(list)
  % Struct array of decoded lines, given as a cell array, without their type. Keys that only some of
  % them have are [] in the others.
  if isempty(list)
    lines = struct('index', {});
    return
  end
  list = cellfun(@(line) rmfield(line, 'type'), list, 'UniformOutput', false);
  names = fieldnames(list{1});
  if ~all(cellfun(@(line) isequal(fieldnames(line), names), list))
    every = cellfun(@fieldnames, list, 'UniformOutput', false);
    names = unique(vertcat(every{:}), 'stable');
    list = cellfun(@(line) filled(line, names), list, 'UniformOutput', false);
  end
  lines = [list{:}];
end

function line = filled(line, names)
  for k = 1:numel(names)
    if ~isfield(line, names{k})
      line.(names{k}) = [];
    end
  end
  line = orderfields(line, names);
end
