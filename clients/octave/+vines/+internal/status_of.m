function [status, head] = status_of(folder)
  % The status that a service has answered with, and the head of its answer; 0 where none has come.
  status = 0;
  head = vines.internal.content(fullfile(folder, 'head'));
  found = regexp(head, '^HTTP/\S+ (\d+)', 'tokens', 'lineanchors');
  if ~isempty(found)
    status = str2double(found{end}{1});
  end
end
