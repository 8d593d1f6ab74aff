function given = fields(pairs)
  % Struct of the fields in a cell array of names and values, or of structs. Later ones override.
  given = struct();
  at = 1;
  while at <= numel(pairs)
    one = pairs{at};
    if isstruct(one) && isscalar(one)
      names = fieldnames(one);
      for k = 1:numel(names)
        given.(names{k}) = one.(names{k});
      end
      at = at + 1;
    elseif (ischar(one) || isa(one, 'string')) && at < numel(pairs)
      name = char(one);
      if ~isvarname(name) && ~iskeyword(name)
        error('vines:arguments', '''%s'' is not a field name', name);
      end
      given.(name) = pairs{at + 1};
      at = at + 2;
    else
      error('vines:arguments', 'fields are given as NAME, VALUE, ... or as a struct');
    end
  end
  if isfield(given, 'format')
    error('vines:arguments', 'answers are structs: format cannot be chosen');
  end
end
