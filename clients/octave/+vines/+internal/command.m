function line = command(folder, request)
  % Shell command that sends REQUEST to the service or the program of the environment. The answer is
  % written to the file out in FOLDER, stderr to err, the header of a service's response to head.
  % The request and the key are passed in files, since every user can see the arguments of a
  % process.
  %
  % REQUEST has route, and either body, or file and query.
  given = fullfile(folder, 'in');
  if isfield(request, 'file')
    given = request.file;
  else
    write(given, request.body);
  end
  if vines.internal.uses_service()
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
    error('vines:arguments', 'VINES_URL: %s is not an http:// or https:// address', url);
  end
  target = [url, '/v1/', request.route];
  kind = 'application/json';
  if isfield(request, 'query')
    target = [target, '?', request.query];
    kind = 'text/csv';
  end
  lines = {'silent', 'show-error', 'no-buffer', 'globoff', ...
           'proto = "=http,https"', ...
           'speed-limit = 1', 'speed-time = 600', ... % s without data
           option('dump-header', fullfile(folder, 'head')), ...
           'data-binary = "@-"', ...
           option('header', ['Content-Type: ', kind]), ...
           option('header', 'Accept: application/json'), ...
           option('header', 'Expect:'), ...
           option('url', target)};
  key = getenv('VINES_KEY');
  if any(key < 32)
    error('vines:arguments', 'VINES_KEY has more than one line');
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
  % MATLAB starts programs with its own library path, with which curl and vines can fail.
  text = '';
  if ~exist('OCTAVE_VERSION', 'builtin')
    text = 'unset LD_LIBRARY_PATH DYLD_LIBRARY_PATH; ';
  end
end
