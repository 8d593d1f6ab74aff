function answer = identify(record, varargin)
  % ANSWER = vines.identify(FILE, NAME, VALUE, ...)
  % ANSWER = vines.identify(COLUMNS, NAME, VALUE, ...)
  % ANSWER = vines.identify([], 'impacts', IMPACTS, NAME, VALUE, ...)
  %
  % Exponents from a measurement. FILE has columns as measuring programs write them; COLUMNS is a
  % struct of vectors, time_s, displacement_m, acceleration_m_s2 (a unit in a name is obeyed);
  % IMPACTS are columns of impacts in place of a record, as a simulation gives them. The other fields
  % are those of docs/api.md, in pairs or in a struct:
  %
  %   found = vines.identify('record.csv', 'preset', 'fig20', 'b', 0.015);
  %   found.restitution.plus.R, found.verdict
  %
  % Errors: those of vines.simulate, and vines:file where FILE cannot be read.
  given = vines.internal.fields(varargin);
  if isa(record, 'string')
    record = char(record);
  end
  if ischar(record)
    request = struct('route', 'identify', 'file', vines.internal.readable(record), ...
                     'query', vines.internal.query(given));
  else
    if ~isempty(record)
      given.record = record;
    end
    request = struct('route', 'identify', 'body', vines.internal.json(given));
  end
  answer = vines.internal.ask(request);
end
