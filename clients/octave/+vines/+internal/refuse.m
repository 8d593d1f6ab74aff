function refuse(outcome, text)
  % Raises the error of a request without an answer. OUTCOME is that of outcome_of.m; TEXT is the
  % body of a service's response.
  with_service = vines.internal.uses_service();
  if any(outcome.code == [126, 127])
    missing(with_service, outcome.message);
  elseif with_service && outcome.code ~= 0
    outcome.status = 0;
    vines.internal.raise('connection', outcome, sprintf('%s cannot be reached: %s', ...
                                                       getenv('VINES_URL'), outcome.message));
  end
  if ~with_service
    text = outcome.message;
  end
  document = [];
  try %#ok<TRYNC>
    document = vines.internal.decode(text);
  end
  if isstruct(document) && isfield(document, 'detail')
    vines.internal.raise('problem', outcome, document);
  elseif isempty(text) || text(1) == '<' % an HTML page of a proxy
    text = 'no reason was given';
    if ~with_service
      text = sprintf('vines ended with %d', outcome.code);
    end
  end
  vines.internal.raise('problem', outcome, text);
end

function missing(with_service, message)
  if with_service
    error('vines:program', 'curl, needed for a service, was not found: %s', message);
  end
  name = getenv('VINES_PROGRAM');
  if isempty(name)
    name = 'vines';
  end
  error('vines:program', ['program %s was not found: put it on the PATH, name it in ', ...
                          'VINES_PROGRAM, or name a service in VINES_URL'], name);
end
