function list = of_type(lines, type)
  % Struct array of the decoded LINES of this TYPE, as combined.m, in order.
  list = vines.internal.combined(lines(cellfun(@(line) strcmp(line.type, type), lines)));
end
