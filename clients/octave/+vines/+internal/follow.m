function [points, course] = follow(request, each, indices)
  % The points of a sweep in order, each told to EACH as it comes; INDICES are those that are asked
  % for, [] for all.
  [folder, cleaner] = vines.internal.room(); %#ok<ASGLU>
  stop = start(folder, vines.internal.command(folder, request));
  course = struct('done', 0, 'total', 0, 'missing', [], 'start', [], 'progress', [], ...
                  'warnings', {{}});
  points = {};
  last = struct('type', '', 'status', 0, 'detail', '');
  at = 0;
  code = '';
  while isempty(code)
    code = vines.internal.content(fullfile(folder, 'code')); % what is there now is the last of it
    [lines, at] = new_lines(folder, at);
    for k = 1:numel(lines)
      line = vines.internal.decode(lines{k});
      switch line.type
        case 'start'
          course = begun(course, line, indices);
          points = cell(1, course.total);
        case 'point'
          course.done = course.done + 1;
          points{course.done} = rmfield(line, 'type');
          if ~isempty(each)
            each(points{course.done}, course);
          end
        case 'progress'
          course.progress = rmfield(line, 'type');
        case 'warning'
          course.warnings{end + 1} = line.message;
        otherwise
          last = line;
      end
    end
    if isempty(code) && isempty(lines)
      pause(0.02);
    end
  end
  clear stop
  points = vines.internal.together(points(1:course.done));
  course.missing = setdiff(course.missing, [points.index]);
  course = conclude(vines.internal.ended(folder, str2double(code)), folder, points, course, last);
end

function course = begun(course, line, indices)
  course.start = line;
  if iscell(line.warnings) % [] of none
    course.warnings = line.warnings(:)';
  end
  course.missing = indices;
  if isempty(indices)
    course.missing = 0:line.points - 1;
  end
  course.total = numel(course.missing);
end

function stop = start(folder, line)
  % Begins LINE beside this program, which looks at the files that it writes. It ends with STOP.
  [~, said] = vines.internal.shell(folder, strjoin({ ...
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
                               ' || kill ', strtrim(said)]));
end

function [lines, at] = new_lines(folder, at)
  % The whole lines behind the first AT bytes. A service's are none of a sweep's where it refuses.
  lines = {};
  if vines.internal.asks_service() && vines.internal.status_of(folder) ~= 200
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

function course = conclude(told, folder, points, course, last)
  if isempty(course.start)
    vines.internal.refuse(told, vines.internal.content(fullfile(folder, 'out')));
  end
  is_well = told.code == 0;
  if vines.internal.asks_service()
    is_well = is_well && strcmp(last.type, 'done');
    told.status = 0;
    if strcmp(last.type, 'error')
      told.status = last.status;
      told.said = last.detail;
    elseif ~is_well
      told.said = ['the stream ended early: ', told.said];
    end
  elseif is_well && ~isempty(told.said)
    course.warnings = [course.warnings, strsplit(told.said, sprintf('\n'))];
  end
  if ~is_well || ~isempty(course.missing)
    came = sprintf('%d of %d points came', course.done, course.total);
    said = regexprep(told.said, '[:;\s]+$', '');
    if ~isempty(said) && ~is_well
      came = [said, '; ', came];
    end
    vines.internal.raise('incomplete', told, came, struct('points', points, 'missing', course.missing));
  end
end
