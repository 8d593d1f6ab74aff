function outcome = outcome_of(folder, code)
  % Outcome of a request whose command ended with CODE: code; message (stderr); for a service also
  % status (0 without a response) and retry_after (s, or NaN).
  [status, head] = vines.internal.http_status(folder);
  message = strtrim(vines.internal.content(fullfile(folder, 'err')));
  outcome = struct('code', code, 'message', regexprep(message, '^vines: ', '', 'lineanchors'), ...
                   'status', status, 'retry_after', NaN);
  seconds = regexpi(head, '^retry-after: *(\d+)', 'tokens', 'lineanchors');
  if ~isempty(seconds)
    outcome.retry_after = str2double(seconds{end}{1});
  end
end
