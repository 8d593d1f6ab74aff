function path = readable_path(path)
  % Absolute path of a file. Raises vines:file if it cannot be read.
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
