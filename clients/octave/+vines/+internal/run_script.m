function [code, message] = run_script(folder, text)
  % Runs TEXT with /bin/sh; in MATLAB, system() uses the user's shell, which can be another one.
  script = fullfile(folder, 'script');
  file = fopen(script, 'w');
  fwrite(file, unicode2native(sprintf('%s\n', text), 'UTF-8'), 'uint8');
  fclose(file);
  [code, message] = system(['/bin/sh ', vines.internal.quoted(script)]);
end
