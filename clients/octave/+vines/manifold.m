function answer = manifold(varargin)
  % ANSWER = vines.manifold(NAME, VALUE, ...)
  %
  % The slow invariant manifold and a recommended b. For the fields, in pairs or in a struct, see
  % docs/api.md:
  %
  %   answer = vines.manifold('b', 0.02);
  %   answer.manifold.recommended.b
  %
  % Errors: vines:problem, vines:connection and vines:program, as those of vines.simulate.
  given = vines.internal.fields(varargin);
  answer = vines.internal.send(struct('route', 'manifold', 'body', vines.internal.json(given)));
end
