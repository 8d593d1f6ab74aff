function refuse(told, text)
  % The error of a request that ended without an answer: TOLD is how, TEXT what came of a service.
  by_service = vines.internal.asks_service();
  if any(told.code == [126, 127])
    missing(by_service, told.said);
  elseif by_service && told.code ~= 0
    told.status = 0;
    vines.internal.raise('connection', told, sprintf('%s cannot be reached: %s', ...
                                                    getenv('VINES_URL'), told.said));
  end
  if ~by_service
    text = told.said;
  end
  document = [];
  try %#ok<TRYNC>
    document = vines.internal.decode(text);
  end
  if isstruct(document) && isfield(document, 'detail')
    vines.internal.raise('problem', told, document);
  elseif isempty(text) || text(1) == '<' % a page that a proxy made
    text = 'no reason was given';
    if ~by_service
      text = sprintf('vines ended with %d', told.code);
    end
  end
  vines.internal.raise('problem', told, text);
end

function missing(by_service, said)
  if by_service
    error('vines:program', 'there is no program curl, which asks a service: %s', said);
  end
  name = getenv('VINES_PROGRAM');
  if isempty(name)
    name = 'vines';
  end
  error('vines:program', ['there is no program %s: put it on the PATH, name it in VINES_PROGRAM, ', ...
                          'or name a service in VINES_URL'], name);
end
