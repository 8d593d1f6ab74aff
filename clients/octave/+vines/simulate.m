function answer = simulate(varargin)
  % ANSWER = vines.simulate(NAME, VALUE, ...)
  % ANSWER = vines.simulate(FIELDS)
  %
  % Simulates one run. For the fields, in pairs or in a struct, see docs/api.md:
  %
  %   run = vines.simulate('preset', 'fig11', 'include', {'impacts', 'regime'});
  %   plot(run.impacts.tau, run.impacts.relative_speed)
  %
  % ANSWER is a struct with the keys of docs/api.md. Null is NaN; lists of numbers are columns. A
  % run that ends early (answer.status.reason is not 'tau_end') issues the warning
  % vines:partialAnswer. Errors: vines:problem (vines.problem() lists the invalid fields),
  % vines:connection, vines:program.
  given = vines.internal.fields(varargin);
  answer = vines.internal.send(struct('route', 'simulate', 'body', vines.internal.json(given)));
  if ~strcmp(answer.status.reason, 'tau_end')
    warning('vines:partialAnswer', '%s: %s', answer.status.reason, answer.status.message);
  end
end
