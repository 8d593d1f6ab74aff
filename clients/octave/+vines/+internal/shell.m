function [code, said] = shell(folder, text)
  % Runs TEXT by /bin/sh: system() takes the user's shell in MATLAB, which may be another one.
  script = fullfile(folder, 'script');
  file = fopen(script, 'w');
  fwrite(file, unicode2native(sprintf('%s\n', text), 'UTF-8'), 'uint8');
  fclose(file);
  [code, said] = system(['/bin/sh ', vines.internal.quoted(script)]);
end
