function text = json(value, name)
  % VALUE as JSON. Numbers have enough digits to be read back exactly; NaN is null. NAME is the name
  % of its field, if any.
  %
  % jsonencode writes only 15 digits, and a list with one element as that element.
  if nargin < 2
    name = '';
  end
  depth = vines.internal.list_depth(name);
  if isa(value, 'string')
    value = cellstr(value);
    if isscalar(value)
      value = value{1};
    end
  end
  if ischar(value)
    text = quoted(value, name);
    if depth > 0 && ~strcmp(name, 'starts') % starts can be the text 'default set'
      text = ['[', text, ']'];
    end
  elseif iscell(value)
    text = list(cellfun(@(one) vines.internal.json(one), value(:)', 'UniformOutput', false));
  elseif isstruct(value) && isscalar(value) && depth == 0
    text = object(value);
  elseif isstruct(value)
    text = list(arrayfun(@object, value(:)', 'UniformOutput', false));
  elseif (isnumeric(value) || islogical(value)) && isreal(value) && ndims(value) == 2
    text = numbers(full(value), name, depth);
  else
    error('vines:arguments', '%s: a %s cannot be sent', name, class(value));
  end
end

function text = object(value)
  names = fieldnames(value);
  members = cell(1, numel(names));
  for k = 1:numel(names)
    members{k} = ['"', names{k}, '":', vines.internal.json(value.(names{k}), names{k})];
  end
  text = ['{', strjoin(members, ','), '}'];
end

function text = list(elements)
  text = ['[', strjoin(elements, ','), ']'];
end

function text = numbers(value, name, depth)
  if any(isinf(value(:)))
    error('vines:arguments', '%s: an infinite number cannot be sent', name);
  end
  if isscalar(value) && depth == 0
    text = vines.internal.number(value);
  elseif isempty(value)
    text = '[]';
  elseif isvector(value) && depth < 2
    text = row(value);
  else
    rows = cell(1, size(value, 1));
    for k = 1:size(value, 1)
      rows{k} = row(value(k, :));
    end
    text = list(rows);
  end
end

function text = row(value)
  if islogical(value)
    text = list(arrayfun(@vines.internal.number, value(:)', 'UniformOutput', false));
  else
    text = sprintf('%.17g,', value);
    text = ['[', strrep(text(1:end - 1), 'NaN', 'null'), ']'];
  end
end

function text = quoted(value, name)
  if ~isempty(value) && ~isrow(value)
    error('vines:arguments', '%s: a text must have one row', name);
  end
  text = strrep(strrep(value, '\', '\\'), '"', '\"');
  for code = unique(double(text(text < 32)))
    text = strrep(text, char(code), sprintf('\\u%04x', code));
  end
  text = ['"', text, '"'];
end
