function [status, head] = http_status(folder)
  % Status and header of a service's response; 0 while there is none.
  status = 0;
  head = vines.internal.content(fullfile(folder, 'head'));
  found = regexp(head, '^HTTP/\S+ (\d+)', 'tokens', 'lineanchors');
  if ~isempty(found)
    status = str2double(found{end}{1});
  end
end
