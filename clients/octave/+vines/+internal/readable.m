function path = readable(path)
  % PATH from the root on, of a file that can be read.
  if isempty(path) || path(1) ~= '/'
    path = fullfile(pwd(), path);
  end
  if isfolder(path)
    error('vines:file', '%s is a folder', path);
  end
  [file, why] = fopen(path, 'r');
  if file < 0
    error('vines:file', '%s cannot be read: %s', path, why);
  end
  fclose(file);
end
