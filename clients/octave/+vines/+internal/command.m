function line = command(folder, request)
  % The shell's line that sends REQUEST to the service or the program of the environment: what is
  % answered goes to the file out of FOLDER, what is said beside it to err, the head of a service's
  % answer to head. What a request says stands in files, as the list of processes is for everybody.
  %
  % REQUEST: route; body, or file and query.
  given = fullfile(folder, 'in');
  if isfield(request, 'file')
    given = request.file;
  else
    write(given, request.body);
  end
  if vines.internal.asks_service()
    write(fullfile(folder, 'config'), config(folder, request));
    words = {'curl', '-q', '--config', fullfile(folder, 'config')};
  else
    words = {program(), request.route};
    if isfield(request, 'query')
      words = [words, {'-q', request.query}];
    end
  end
  words = cellfun(@vines.internal.quoted, words, 'UniformOutput', false);
  line = sprintf('%s%s <%s >%s 2>%s', libraries(), strjoin(words, ' '), ...
                 vines.internal.quoted(given), ...
                 vines.internal.quoted(fullfile(folder, 'out')), ...
                 vines.internal.quoted(fullfile(folder, 'err')));
end

function path = program()
  path = getenv('VINES_PROGRAM');
  if isempty(path)
    path = 'vines';
  end
end

function text = config(folder, request)
  url = regexprep(getenv('VINES_URL'), '/+$', '');
  if isempty(regexp(url, '^https?://', 'once'))
    error('vines:arguments', 'VINES_URL: %s is no http:// or https:// address', url);
  end
  target = [url, '/v1/', request.route];
  kind = 'application/json';
  if isfield(request, 'query')
    target = [target, '?', request.query];
    kind = 'text/csv';
  end
  lines = {'silent', 'show-error', 'no-buffer', 'globoff', ...
           'proto = "=http,https"', ...
           'speed-limit = 1', 'speed-time = 600', ... % seconds without a byte
           option('dump-header', fullfile(folder, 'head')), ...
           'data-binary = "@-"', ...
           option('header', ['Content-Type: ', kind]), ...
           option('header', 'Accept: application/json'), ...
           option('header', 'Expect:'), ...
           option('url', target)};
  key = getenv('VINES_KEY');
  if any(key < 32)
    error('vines:arguments', 'VINES_KEY is more than one line');
  elseif ~isempty(key)
    lines{end + 1} = option('header', ['Authorization: Bearer ', key]);
  end
  text = sprintf('%s\n', lines{:});
end

function line = option(name, value)
  line = sprintf('%s = "%s"', name, strrep(strrep(value, '\', '\\'), '"', '\"'));
end

function write(path, text)
  [file, why] = fopen(path, 'w');
  if file < 0
    error('vines:file', '%s cannot be written: %s', path, why);
  end
  bytes = unicode2native(text, 'UTF-8');
  written = fwrite(file, bytes, 'uint8');
  if fclose(file) ~= 0 || written ~= numel(bytes)
    error('vines:file', '%s cannot be written: is the disk full?', path);
  end
end

function text = libraries()
  % MATLAB makes its own libraries those of the programs that it starts.
  text = '';
  if ~exist('OCTAVE_VERSION', 'builtin')
    text = 'unset LD_LIBRARY_PATH DYLD_LIBRARY_PATH; ';
  end
end
