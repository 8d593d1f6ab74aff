function [points, info, last] = follow_sweep(request, each, indices)
  % Runs a sweep and returns its points in order, and its last line. EACH is called with each
  % point as it arrives; INDICES are the requested ones, [] for all.
  %
  % The command runs in the background and writes to files, which this function reads every 20 ms.
  [folder, cleaner] = vines.internal.request_folder(); %#ok<ASGLU>
  stop = start(folder, vines.internal.command(folder, request));
  info = struct('done', 0, 'total', 0, 'missing', [], 'start', [], 'progress', [], ...
                'warnings', {{}});
  points = {};
  last = struct('type', '', 'status', 0, 'detail', '');
  at = 0;
  code = '';
  while isempty(code)
    % The exit code is read before the lines: once it exists, all lines are written.
    code = vines.internal.content(fullfile(folder, 'code'));
    [lines, at] = new_lines(folder, at);
    for k = 1:numel(lines)
      line = vines.internal.decode(lines{k});
      switch line.type
        case 'start'
          info = started(info, line, indices);
          points = cell(1, info.total);
        case 'point'
          info.done = info.done + 1;
          points{info.done} = line;
          if ~isempty(each)
            each(rmfield(line, 'type'), info);
          end
        case 'progress'
          info.progress = rmfield(line, 'type');
        case 'warning'
          info.warnings{end + 1} = line.message;
        otherwise
          last = line;
      end
    end
    if isempty(code) && isempty(lines)
      pause(0.02);
    end
  end
  clear stop
  points = vines.internal.combined(points(1:info.done));
  [~, order] = sort([points.index]);
  points = points(order);
  info.missing = setdiff(info.missing, [points.index]);
  info = conclude(vines.internal.outcome_of(folder, str2double(code)), folder, points, info, last);
end

function info = started(info, line, indices)
  info.start = line;
  if iscell(line.warnings) % [] if there are none
    info.warnings = line.warnings(:)';
  end
  info.missing = indices;
  if isempty(indices)
    info.missing = 0:line.points - 1;
  end
  info.total = numel(info.missing);
end

function stop = start(folder, line)
  % Starts the shell command LINE in the background. Deleting STOP ends it.
  [~, message] = vines.internal.run_script(folder, strjoin({ ...
    ['cd ', vines.internal.quoted(pwd())], ...
    '(', ...
    '  trap ''kill $running'' TERM', ...
    ['  ', line, ' &'], ...
    '  running=$!', ...
    '  wait $running', ...
    ['  echo $? >', vines.internal.quoted(fullfile(folder, 'code'))], ...
    ') </dev/null >/dev/null 2>&1 &', ...
    'echo $!'}, sprintf('\n')));
  stop = onCleanup(@() system(['test -e ', vines.internal.quoted(fullfile(folder, 'code')), ...
                               ' || kill ', strtrim(message)]));
end

function [lines, at] = new_lines(folder, at)
  % Complete lines after the first AT bytes. If a service refuses, its answer is not a sweep's.
  lines = {};
  if vines.internal.uses_service() && vines.internal.http_status(folder) ~= 200
    return
  end
  file = fopen(fullfile(folder, 'out'), 'r');
  if file < 0
    return
  end
  fseek(file, at, 'bof');
  bytes = fread(file, [1, Inf], '*uint8');
  fclose(file);
  whole = find(bytes == 10, 1, 'last');
  if ~isempty(whole)
    at = at + whole;
    lines = strsplit(native2unicode(bytes(1:whole - 1), 'UTF-8'), sprintf('\n'));
  end
end

function info = conclude(outcome, folder, points, info, last)
  if isempty(info.start)
    vines.internal.refuse(outcome, vines.internal.content(fullfile(folder, 'out')));
  end
  succeeded = outcome.code == 0;
  if vines.internal.uses_service()
    succeeded = succeeded && strcmp(last.type, 'done');
    outcome.status = 0;
    if strcmp(last.type, 'error')
      outcome.status = last.status;
      outcome.message = last.detail;
    elseif ~succeeded
      outcome.message = ['the stream ended early: ', outcome.message];
    end
  elseif succeeded && ~isempty(outcome.message)
    info.warnings = [info.warnings, strsplit(outcome.message, sprintf('\n'))];
  end
  if ~succeeded || ~isempty(info.missing)
    detail = sprintf('received %d of %d points', info.done, info.total);
    message = regexprep(outcome.message, '[:;\s]+$', '');
    if ~isempty(message) && ~succeeded
      detail = [message, '; ', detail];
    end
    vines.internal.raise('incomplete', outcome, detail, ...
                         struct('points', points, 'missing', info.missing));
  end
end
