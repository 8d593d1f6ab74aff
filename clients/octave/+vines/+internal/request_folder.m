function [folder, cleaner] = request_folder()
  % New folder for the files of a request, readable only by its owner. Deleting CLEANER removes it.
  [code, message] = system('mktemp -d');
  if code ~= 0
    error('vines:file', 'no temporary folder can be created: %s', strtrim(message));
  end
  folder = strtrim(message);
  cleaner = onCleanup(@() system(['rm -rf ', vines.internal.quoted(folder)]));
end
