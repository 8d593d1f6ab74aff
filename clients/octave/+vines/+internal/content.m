function text = content(path)
  % Text of a file; '' if it does not exist.
  text = '';
  file = fopen(path, 'r');
  if file >= 0
    text = native2unicode(fread(file, [1, Inf], '*uint8'), 'UTF-8');
    fclose(file);
  end
end
