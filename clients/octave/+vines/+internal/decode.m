function value = decode(text)
  % JSON as structs, columns and cells; null is NaN.
  %
  % jsondecode knows that in lists of numbers, but else makes [] of it, as of an empty list: a null
  % goes in as a word that no answer has.
  marked = regexprep(text, '(?<=[^\\]":)\s*null', '"\\u0001"');
  value = jsondecode(marked);
  if numel(marked) ~= numel(text)
    value = with_nan(value, char(1));
  end
end

function value = with_nan(value, null)
  if isstruct(value)
    names = fieldnames(value);
    if ~isempty(names)
      value = cell2struct(each_with_nan(struct2cell(value), null), names, 1);
    end
  elseif iscell(value)
    value = each_with_nan(value, null);
  end
end

function values = each_with_nan(values, null)
  values(strcmp(values, null)) = {NaN};
  deeper = find(cellfun('isclass', values, 'struct') | cellfun('isclass', values, 'cell'));
  for k = deeper(:)'
    values{k} = with_nan(values{k}, null);
  end
end
