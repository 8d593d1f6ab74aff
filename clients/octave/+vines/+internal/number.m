function text = number(value)
  % A number as JSON, with the fewest digits that are read back exactly; NaN is null.
  if islogical(value)
    words = {'false', 'true'};
    text = words{value + 1};
  elseif isinteger(value)
    text = sprintf('%d', value);
  elseif isnan(value)
    text = 'null';
  else
    for digits = 15:17
      text = sprintf('%.*g', digits, value);
      if str2double(text) == value
        break
      end
    end
  end
end
