function value = decode(text)
  % Decodes JSON into structs, columns and cells; null is NaN.
  %
  % jsondecode reads null as NaN only in lists of numbers, elsewhere as [], like an empty list. Such
  % a null is therefore replaced by a text that no answer contains.
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
