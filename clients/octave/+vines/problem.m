function told = problem(latest)
  % PROBLEM = vines.problem()
  %
  % Why the latest request that failed has no answer, or not all of it:
  %
  %   try
  %     vines.simulate('b', -1);
  %   catch
  %     told = vines.problem();
  %     told.errors(1)            % field 'b', value -1, range [1e-9; 1000], detail
  %   end
  %
  % status    as of HTTP, whichever way was asked; 0 where neither service nor program said one
  % detail    a sentence
  % errors    each field at fault: field (within others a path, as axes/0/from), value, range
  %           ([minimum; maximum], or the choices, or NaN), detail
  % lacking, retry_after    of 503: what the service has no more of, and seconds after which to ask
  % request_id              by which the service's log names the request
  % points, missing         of a sweep: what came, and the indices of what did not
  persistent kept
  if nargin > 0
    kept = latest;
  end
  told = kept;
end
