function raise(kind, outcome, document, received)
  % Raises the error vines:KIND and stores its details for vines.problem(). DOCUMENT is a problem
  % document (RFC 9457) or a sentence; RECEIVED has the points received from a sweep, and missing.
  problem = struct('status', outcome.status, 'title', '', 'detail', '', 'errors', no_errors(), ...
                   'lacking', '', 'request_id', '', 'retry_after', outcome.retry_after);
  if ischar(document)
    problem.detail = document;
  else
    for name = {'status', 'title', 'detail', 'lacking', 'request_id'}
      if isfield(document, name{1})
        problem.(name{1}) = document.(name{1});
      end
    end
    if isfield(document, 'errors')
      problem.errors = errors(document.errors);
    end
  end
  if nargin > 3
    problem.points = received.points;
    problem.missing = received.missing;
  end
  vines.problem(problem);
  error(['vines:', kind], '%s', message(problem));
end

function list = no_errors()
  list = struct('field', {}, 'value', {}, 'range', {}, 'detail', {});
end

function list = errors(documents)
  list = no_errors();
  for k = 1:numel(documents)
    one = documents(k);
    if iscell(one)
      one = one{1};
    end
    % RFC 6901 escapes / and ~ in the names of a pointer.
    field = strrep(strrep(regexprep(one.pointer, '^/', ''), '~1', '/'), '~0', '~');
    list(k) = struct('field', field, 'value', {one.value}, 'range', {one.range}, ...
                     'detail', one.detail);
  end
end

function text = message(problem)
  % With one invalid field, the document's detail is the field's detail.
  faults = {problem.errors.detail};
  text = strjoin([{problem.detail}, faults(~strcmp(faults, problem.detail))], '; ');
  if problem.status > 0
    text = sprintf('%d: %s', problem.status, text);
  end
end
