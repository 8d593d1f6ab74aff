function result = problem(latest)
  % PROBLEM = vines.problem()
  %
  % Details of the latest vines:problem, vines:incomplete or vines:connection:
  %
  %   try
  %     vines.simulate('b', -1);
  %   catch
  %     p = vines.problem();
  %     p.errors(1)               % field 'b', value -1, range [1e-9; 1000], detail
  %   end
  %
  % status    HTTP status, for the program too; 0 if there is none
  % detail    a sentence
  % errors    the invalid fields: field (a path if nested, such as axes/0/from), value, range
  %           ([minimum; maximum], or the choices, or NaN), detail
  % lacking, retry_after    for 503: the exhausted resource, and the seconds to wait
  % request_id              identifies the request in the service's log
  % points, missing         for a sweep: the points received, and the indices of the others
  persistent kept
  if nargin > 0
    kept = latest;
  end
  result = kept;
end
