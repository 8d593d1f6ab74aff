% The client for Octave and MATLAB against a service, one with a key, and the program:
% tests/clients/clients.test.mjs starts them and says where they are.
1;

function by_service()
  setenv('VINES_URL', getenv('TEST_SERVICE'));
end

function by_locked(key)
  setenv('VINES_URL', getenv('TEST_LOCKED'));
  setenv('VINES_KEY', key);
end

function by_program(path)
  setenv('VINES_URL', '');
  if nargin > 0
    setenv('VINES_PROGRAM', path);
  end
end

function same(got, expected)
  assert(isequaln(got, expected), '%s is not %s', disp(got), disp(expected));
end

function told = refused(identifier, act)
  % The error's message; vines.problem() has the rest.
  told = '';
  try
    act();
  catch wrong
    assert(strcmp(wrong.identifier, identifier), '%s: %s', wrong.identifier, wrong.message);
    told = wrong.message;
  end
  assert(~isempty(told), 'no error %s', identifier);
end

function axis = line(count)
  axis = struct('parameter', 'b', 'from', 0.01, 'to', 0.05, 'count', count);
end

% Both ways.

function a_run_has_its_lists_as_columns_and_its_parts_as_structs()
  run = vines.simulate('b', 0.022, 'tau_end', 200, 'include', {'impacts', 'matrices'});
  same(run.status.reason, 'tau_end');
  same(size(run.impacts.tau), [numel(run.impacts.side), 1]);
  same(size(run.matrices.T), [numel(run.matrices.tau), 4, 4]);
  same(run.parameters.b, 0.022);
end

function fields_are_pairs_or_a_struct_or_both()
  fields = struct('preset', 'fig11', 'tau_end', 50);
  one = vines.simulate(fields, 'tau_end', 30, 'lambda', 1.4);
  same(one.parameters.tau_end, 30);
  same(one.parameters.lambda, 1.4);
  refused('vines:arguments', @() vines.simulate('b'));
  refused('vines:arguments', @() vines.simulate('preset', 'fig11', 'format', 'csv'));
  refused('vines:arguments', @() vines.simulate('b', Inf));
end

function one_word_or_number_stands_for_a_list_of_one()
  run = vines.simulate('tau_end', 100, 'include', 'impacts', 'fields', 'impacts.tau');
  assert(numel(run.impacts.tau) > 1);
  points = vines.sweep('axes', struct('parameter', 'b', 'values', 0.03), 'cycles', 20, ...
                       'transient_cycles', 5);
  same([points.b], 0.03);
  run = vines.simulate('tau_end', 200, 'windows', [0, 100]);
  same(run.windows(1).asked, [0; 100]);
end

function a_number_goes_and_comes_with_all_of_its_digits()
  for b = [0.1 + 0.2, 1 / 3, 0.022, 1e-7]
    run = vines.simulate('b', b, 'tau_end', 1);
    same(run.parameters.b, b);
  end
end

function null_is_nan_and_no_empty_list_is()
  same(vines.internal.decode('{"a":null,"b":[],"c":[1,null],"d":["\":null"],"e":[{"f":null},{"f":2}]}'), ...
       struct('a', NaN, 'b', [], 'c', [1; NaN], 'd', {{'":null'}}, 'e', struct('f', {NaN; 2})));
  run = vines.simulate('tau_end', 30, 'include', {'regime', 'exponents'});
  same(run.regime.capture, NaN);
  same(run.exponents.qr.final, NaN(4, 1));
  same(run.exponents.qr.history.tau, []);
  point = vines.sweep('axes', line(1), 'cycles', 5, 'transient_cycles', 0);
  same(numel([point.standard_error]), 4);
end

function a_request_at_fault_names_its_fields()
  told = refused('vines:problem', @() vines.simulate('b', -1, 'Omga', 2));
  assert(~isempty(strfind(told, 'did you mean Omega?')), told);
  problem = vines.problem();
  same(problem.status, 422);
  same({problem.errors.field}, {'b', 'Omga'});
  same(problem.errors(1).value, -1);
  same(problem.errors(1).range, [1e-9; 1000]);
  same(problem.errors(2).range, NaN);
end

function a_run_that_ends_early_is_an_answer_with_a_warning()
  warning('error', 'vines:partialAnswer', 'local');
  told = refused('vines:partialAnswer', @() vines.simulate('max_impacts', 5));
  assert(~isempty(strfind(told, 'max_impacts: ')), told);
  warning('off', 'vines:partialAnswer', 'local');
  run = vines.simulate('max_impacts', 5);
  same(run.status.reason, 'max_impacts');
end

function a_sweep_gives_its_points_as_they_come_and_counts_them()
  global came
  came = [];
  [points, course] = vines.sweep(@note, 'axes', line(12), 'cycles', 50, 'base', struct('lambda', 1.4));
  same(came(:, 1)', 1:12);
  same(sort(came(:, 2))', 0:11);
  same([points.index], 0:11);
  same(size([points.lambda]), [4, 12]);
  same(course.start.parameters.lambda, 1.4);
  same([course.done, course.total, numel(course.missing)], [12, 12, 0]);
  assert(any(cellfun(@(w) ~isempty(strfind(w, 'depends on the start')), course.warnings)));
end

function note(point, course)
  global came
  came(end + 1, :) = [course.done, point.index];
  same(course.total, 12);
end

function points_that_differ_in_their_keys_are_one_array()
  starts = {struct('x0', 0.001), struct('x0', 0.002)};
  points = vines.sweep('axes', {line(3), struct('parameter', 'lambda', 'values', [1.3, 1.4])}, ...
                       'starts', starts, 'cycles', 20, 'indices', [1, 5, 11]);
  same([points.index], [1, 5, 11]);
end

function a_sweep_at_fault_says_so()
  refused('vines:problem', @() vines.sweep('axes', line(-3)));
  problem = vines.problem();
  same(problem.errors.field, 'axes/0/count');
end

function an_error_in_the_callback_ends_the_computing()
  refused('test:enough', @() vines.sweep(@enough, 'axes', line(4000), 'cycles', 20000));
  for wait = 1:100
    if isempty(computing())
      break
    end
    pause(0.1);
  end
  same(computing(), {});
end

function enough(~, ~)
  same(numel(computing()), 1);
  error('test:enough', 'enough');
end

function a_sweep_that_breaks_off_has_what_came()
  refused('vines:incomplete', @() vines.sweep(@end_it, 'axes', line(4000), 'cycles', 2000));
  problem = vines.problem();
  assert(numel(problem.points) > 0);
  same(sort([[problem.points.index], problem.missing]), 0:3999);
  rest = vines.sweep('axes', line(4000), 'cycles', 5, 'transient_cycles', 0, ...
                     'indices', problem.missing(1:3));
  same([rest.index], problem.missing(1:3));
end

function end_it(~, course)
  if course.done == 1
    rows = computing();
    system(sprintf('kill %d', sscanf(rows{1}, '%d', 1)));
  end
end

function rows = computing()
  % The processes that compute for this test, which has its own name of the program.
  [~, said] = system('ps -eo pid=,args= | grep -F "$TEST_ROOM" | grep -E " sweep|curl" | grep -v grep');
  rows = strsplit(strtrim(said), sprintf('\n'));
  rows = rows(~cellfun('isempty', rows));
end

function a_file_and_its_columns_have_one_identification()
  table = dlmread(getenv('TEST_RECORD'), ',', 1, 0);
  columns = struct('time_s', table(:, 1), 'displacement_m', table(:, 2), ...
                   'acceleration_m_s2', table(:, 3));
  of_file = vines.identify(getenv('TEST_RECORD'), 'preset', 'fig20', 'b', 0.015);
  of_columns = vines.identify(columns, struct('preset', 'fig20', 'b', 0.015));
  assert(numel(of_file.impacts.tau) > 10);
  same(of_file.restitution, of_columns.restitution);
end

function impacts_of_a_run_are_a_measurement()
  run = vines.simulate('b', 0.015, 'R', 0.7, 'tau_end', 300, 'include', 'impacts');
  found = vines.identify([], 'impacts', run.impacts, 'b', 0.015);
  assert(abs(found.restitution.plus.R - 0.7) < 1e-9);
end

function lists_stand_beside_a_file()
  found = vines.identify(getenv('TEST_RECORD'), 'preset', 'fig20', 'b', 0.015, ...
                         'fixed', {'b', 'phase'}, 'phase', 0, 'include', 'motion');
  same(found.fitted.phase.fixed, true);
  same(isfield(found, 'motion'), true);
  refused('vines:arguments', @() vines.identify(getenv('TEST_RECORD'), 'record', struct('a', 1)));
end

function a_file_may_have_any_name_and_must_be_there()
  folder = fullfile(getenv('TEST_ROOM'), 'it''s $HOME "and" `more`; # ä \');
  if ~isfolder(folder)
    mkdir(folder);
  end
  file = fopen(fullfile(folder, '-q $(id).csv'), 'w');
  fwrite(file, fileread(getenv('TEST_RECORD')));
  fclose(file);
  here = cd(folder);
  back = onCleanup(@() cd(here));
  found = vines.identify('-q $(id).csv', 'preset', 'fig20', 'b', 0.015);
  assert(numel(found.impacts.tau) > 10);
  refused('vines:file', @() vines.identify('/nowhere/record.csv', 'preset', 'fig20'));
end

function nothing_is_left_behind()
  vines.simulate('tau_end', 20);
  vines.sweep('axes', line(2), 'cycles', 5);
  refused('vines:problem', @() vines.simulate('b', -1));
  same(numel(dir(getenv('TMPDIR'))), 2);
end

% One way.

function both_ways_have_the_same_numbers()
  answers = {};
  for way = {@by_service, @by_program}
    way{1}();
    answers{end + 1} = rmfield(vines.simulate('preset', 'fig11', 'tau_end', 300), 'provenance');
  end
  same(answers{:});
end

function a_deadline_is_told_and_not_hidden()
  by_locked(getenv('TEST_KEY'));
  warning('error', 'vines:partialAnswer', 'local');
  told = refused('vines:partialAnswer', ...
                 @() vines.simulate('b', 0.003, 'R', 1, 'tau_end', 1e7, 'max_impacts', 2000000, ...
                                    'include', 'exponents'));
  assert(~isempty(strfind(told, 'deadline: ')), told);
end

function a_key_is_shown_where_there_is_one()
  by_locked('');
  refused('vines:problem', @() vines.simulate('tau_end', 20));
  problem = vines.problem();
  same(problem.status, 401);
  by_locked(getenv('TEST_KEY'));
  run = vines.simulate('tau_end', 20);
  same(run.status.reason, 'tau_end');
  by_locked(sprintf('two\nlines'));
  refused('vines:arguments', @() vines.simulate('tau_end', 20));
end

function a_key_and_a_request_do_not_stand_in_the_list_of_processes()
  by_locked(getenv('TEST_KEY'));
  global listed
  listed = '';
  % A number that no other process has, whatever runs beside.
  vines.sweep(@look, 'base', struct('G', 0.0219876543), 'axes', line(40), 'cycles', 3000);
  assert(~isempty(strfind(listed, 'curl -q --config')), 'curl runs');
  assert(isempty(strfind(listed, getenv('TEST_KEY'))), 'the key is listed');
  assert(isempty(strfind(listed, '219876543')), 'the request is listed');
end

function look(~, course)
  global listed
  if course.done == 1
    [~, listed] = system('ps -eo args=');
  end
end

function nobody_there_is_an_error_and_so_is_no_program()
  setenv('VINES_URL', 'http://127.0.0.1:9');
  refused('vines:connection', @() vines.simulate('tau_end', 20));
  refused('vines:connection', @() vines.sweep('axes', line(3)));
  setenv('VINES_URL', 'ftp://127.0.0.1');
  refused('vines:arguments', @() vines.simulate('tau_end', 20));
  program = getenv('VINES_PROGRAM');
  by_program('no-such-program');
  told = refused('vines:program', @() vines.simulate('tau_end', 20));
  assert(~isempty(strfind(told, 'VINES_PROGRAM')), told);
  refused('vines:program', @() vines.sweep('axes', line(3)));
  setenv('VINES_PROGRAM', program);
end

function failed = tried(name, way)
  failed = 0;
  try
    feval(name);
    fprintf('ok - %s%s\n', strrep(name, '_', ' '), way);
  catch wrong
    failed = 1;
    fprintf('not ok - %s%s: %s\n', strrep(name, '_', ' '), way, wrong.message);
    for k = 1:numel(wrong.stack)
      fprintf('    %s:%d\n', wrong.stack(k).name, wrong.stack(k).line);
    end
  end
end

both = {'a_run_has_its_lists_as_columns_and_its_parts_as_structs', ...
        'fields_are_pairs_or_a_struct_or_both', ...
        'one_word_or_number_stands_for_a_list_of_one', ...
        'a_number_goes_and_comes_with_all_of_its_digits', ...
        'null_is_nan_and_no_empty_list_is', ...
        'a_request_at_fault_names_its_fields', ...
        'a_run_that_ends_early_is_an_answer_with_a_warning', ...
        'a_sweep_gives_its_points_as_they_come_and_counts_them', ...
        'points_that_differ_in_their_keys_are_one_array', ...
        'a_sweep_at_fault_says_so', ...
        'an_error_in_the_callback_ends_the_computing', ...
        'a_sweep_that_breaks_off_has_what_came', ...
        'a_file_and_its_columns_have_one_identification', ...
        'impacts_of_a_run_are_a_measurement', ...
        'lists_stand_beside_a_file', ...
        'a_file_may_have_any_name_and_must_be_there', ...
        'nothing_is_left_behind'};
one = {'both_ways_have_the_same_numbers', ...
       'a_deadline_is_told_and_not_hidden', ...
       'a_key_is_shown_where_there_is_one', ...
       'a_key_and_a_request_do_not_stand_in_the_list_of_processes', ...
       'nobody_there_is_an_error_and_so_is_no_program'};
failed = 0;
for k = 1:numel(both)
  by_service();
  failed = failed + tried(both{k}, ', by a service');
  by_program();
  failed = failed + tried(both{k}, ', by the program');
end
for k = 1:numel(one)
  setenv('VINES_KEY', '');
  failed = failed + tried(one{k}, '');
end
fprintf('%d failed\n', failed);
exit(double(failed > 0));
