function answer = identify(record, varargin)
  % ANSWER = vines.identify(FILE, NAME, VALUE, ...)
  % ANSWER = vines.identify(COLUMNS, NAME, VALUE, ...)
  % ANSWER = vines.identify([], 'impacts', IMPACTS, NAME, VALUE, ...)
  %
  % Identifies impacts, restitution and Lyapunov exponents from a measurement. FILE is a text file
  % with columns. COLUMNS is a struct of vectors such as time_s, displacement_m, acceleration_m_s2;
  % the unit in a name is respected. IMPACTS, as in a simulation's answer, replace a record. For the
  % other fields, in pairs or in a struct, see docs/api.md:
  %
  %   found = vines.identify('record.csv', 'preset', 'fig20', 'b', 0.015);
  %   found.restitution.plus.R, found.verdict
  %
  % Errors: those of vines.simulate, and vines:file if FILE cannot be read.
  given = vines.internal.fields(varargin);
  if isa(record, 'string')
    record = char(record);
  end
  if ischar(record)
    request = struct('route', 'identify', 'file', vines.internal.readable_path(record), ...
                     'query', vines.internal.query(given));
  else
    if ~isempty(record)
      given.record = record;
    end
    request = struct('route', 'identify', 'body', vines.internal.json(given));
  end
  answer = vines.internal.send(request);
end
