function raise(kind, told, document, came)
  % Ends a request with the error vines:KIND, and keeps what vines.problem() tells of it: DOCUMENT is
  % a problem document (RFC 9457) or a sentence, CAME what came of a sweep.
  problem = struct('status', told.status, 'title', '', 'detail', '', 'errors', no_errors(), ...
                   'lacking', '', 'request_id', '', 'retry_after', told.retry_after);
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
    problem.points = came.points;
    problem.missing = came.missing;
  end
  vines.problem(problem);
  error(['vines:', kind], '%s', message(problem));
end

function list = no_errors()
  list = struct('field', {}, 'value', {}, 'range', {}, 'detail', {});
end

function list = errors(told)
  list = no_errors();
  for k = 1:numel(told)
    one = told(k);
    if iscell(one)
      one = one{1};
    end
    % RFC 6901 escapes these two in the names that a pointer consists of.
    field = strrep(strrep(regexprep(one.pointer, '^/', ''), '~1', '/'), '~0', '~');
    list(k) = struct('field', field, 'value', {one.value}, 'range', {one.range}, ...
                     'detail', one.detail);
  end
end

function text = message(problem)
  % Where one field is at fault the document's detail is that field's.
  faults = {problem.errors.detail};
  text = strjoin([{problem.detail}, faults(~strcmp(faults, problem.detail))], '; ');
  if problem.status > 0
    text = sprintf('%d: %s', problem.status, text);
  end
end
