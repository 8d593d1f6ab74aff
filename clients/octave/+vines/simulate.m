function answer = simulate(varargin)
  % ANSWER = vines.simulate(NAME, VALUE, ...)
  % ANSWER = vines.simulate(FIELDS)
  %
  % One run. Fields are those of docs/api.md by their names, in pairs or in a struct:
  %
  %   run = vines.simulate('preset', 'fig11', 'include', {'impacts', 'regime'});
  %   plot(run.impacts.tau, run.impacts.R)
  %
  % ANSWER is a struct with the keys of docs/api.md; null is NaN, lists of numbers are columns. A run
  % that does not come to its end (answer.status.reason is not 'tau_end') warns with
  % vines:partialAnswer. Errors: vines:problem, of which vines.problem() has the fields at fault;
  % vines:connection, vines:program.
  given = vines.internal.fields(varargin);
  answer = vines.internal.ask(struct('route', 'simulate', 'body', vines.internal.json(given)));
  if ~strcmp(answer.status.reason, 'tau_end')
    warning('vines:partialAnswer', '%s: %s', answer.status.reason, answer.status.message);
  end
end
