function [folder, cleaner] = room()
  % A new folder that only its owner can read, for what a request says and gets. It goes when CLEANER
  % does.
  [code, said] = system('mktemp -d');
  if code ~= 0
    error('vines:file', 'there is no room for temporary files: %s', strtrim(said));
  end
  folder = strtrim(said);
  cleaner = onCleanup(@() system(['rm -rf ', vines.internal.quoted(folder)]));
end
