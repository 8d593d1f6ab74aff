function text = query(given)
  % Fields as a URL query; the elements of lists are separated by commas.
  names = fieldnames(given);
  pairs = cell(1, numel(names));
  for k = 1:numel(names)
    pairs{k} = [escaped(names{k}), '=', escaped(plain(given.(names{k}), names{k}))];
  end
  text = strjoin(pairs, '&');
end

function text = plain(value, name)
  if isa(value, 'string')
    value = cellstr(value);
  end
  if ischar(value)
    text = value;
  elseif iscell(value)
    text = strjoin(cellfun(@(one) plain(one, name), value(:)', 'UniformOutput', false), ',');
  elseif isstruct(value)
    error('vines:arguments', '%s: with a file, no field can be an object', name);
  else
    text = strrep(strrep(strrep(vines.internal.json(value, name), '[', ''), ']', ''), '"', '');
  end
end

function text = escaped(text)
  bytes = unicode2native(text, 'UTF-8');
  kept = ismember(bytes, uint8(['a':'z', 'A':'Z', '0':'9', '-._~,']));
  parts = cell(1, numel(bytes));
  for k = 1:numel(bytes)
    if kept(k)
      parts{k} = char(bytes(k));
    else
      parts{k} = sprintf('%%%02X', bytes(k));
    end
  end
  text = [parts{:}];
end
