function told = ended(folder, code)
  % What a request that ended with CODE came to: code; said, on stderr; of a service, status (0
  % without an answer) and retry_after.
  [status, head] = vines.internal.status_of(folder);
  said = strtrim(vines.internal.content(fullfile(folder, 'err')));
  told = struct('code', code, 'said', regexprep(said, '^vines: ', '', 'lineanchors'), ...
                'status', status, 'retry_after', NaN);
  seconds = regexpi(head, '^retry-after: *(\d+)', 'tokens', 'lineanchors');
  if ~isempty(seconds)
    told.retry_after = str2double(seconds{end}{1});
  end
end
