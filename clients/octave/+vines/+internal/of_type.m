function list = of_type(lines, type)
  % Struct array of the decoded LINES of this TYPE, in order. Keys that only some of them have are []
  % in the others.
  lines = lines(cellfun(@(line) strcmp(line.type, type), lines));
  for k = 1:numel(lines)
    lines{k} = setfield(rmfield(lines{k}, 'type'), 'index', k); %#ok<SFLD>
  end
  list = vines.internal.combined(lines);
  if ~isempty(list)
    list = rmfield(list, 'index');
  end
end
