% Tests of the client for Octave and MATLAB with a service, a service with a key, and the program.
% tests/clients/octave.test.mjs starts them and passes their addresses in the environment.
1;

function use_service()
  setenv('VINES_URL', getenv('TEST_SERVICE'));
end

function use_locked_service(key)
  setenv('VINES_URL', getenv('TEST_LOCKED'));
  setenv('VINES_KEY', key);
end

function use_program(path)
  setenv('VINES_URL', '');
  if nargin > 0
    setenv('VINES_PROGRAM', path);
  end
end

function same(got, expected)
  assert(isequaln(got, expected), '%s is not %s', disp(got), disp(expected));
end

function message = refused(identifier, act)
  % Asserts that ACT raises this error. Returns its message; vines.problem() has the details.
  message = '';
  try
    act();
  catch wrong
    assert(strcmp(wrong.identifier, identifier), '%s: %s', wrong.identifier, wrong.message);
    message = wrong.message;
  end
  assert(~isempty(message), 'no error %s', identifier);
end

function axis = line(count)
  axis = struct('parameter', 'b', 'from', 0.01, 'to', 0.05, 'count', count);
end

% Tests run with the service and with the program.

function a_run_has_lists_as_columns_and_parts_as_structs()
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

function a_single_value_is_sent_as_a_list_with_one_element()
  run = vines.simulate('tau_end', 100, 'include', 'impacts', 'fields', 'impacts.tau');
  assert(numel(run.impacts.tau) > 1);
  points = vines.sweep('axes', struct('parameter', 'b', 'values', 0.03), 'cycles', 20, ...
                       'transient_cycles', 5);
  same([points.b], 0.03);
  run = vines.simulate('tau_end', 200, 'windows', [0, 100]);
  same(run.windows(1).asked, [0; 100]);
end

function numbers_are_exchanged_exactly()
  for b = [0.1 + 0.2, 1 / 3, 0.022, 1e-7]
    run = vines.simulate('b', b, 'tau_end', 1);
    same(run.parameters.b, b);
  end
end

function null_is_nan_but_an_empty_list_is_not()
  same(vines.internal.decode('{"a":null,"b":[],"c":[1,null],"d":["\":null"],"e":[{"f":null},{"f":2}]}'), ...
       struct('a', NaN, 'b', [], 'c', [1; NaN], 'd', {{'":null'}}, 'e', struct('f', {NaN; 2})));
  run = vines.simulate('tau_end', 30, 'include', {'regime', 'exponents'});
  same(run.regime.capture, NaN);
  same(run.exponents.qr.final, NaN(4, 1));
  same(run.exponents.qr.history.tau, []);
  point = vines.sweep('axes', line(1), 'cycles', 5, 'transient_cycles', 0);
  same(numel([point.standard_error]), 4);
end

function the_error_of_an_invalid_request_names_its_fields()
  message = refused('vines:problem', @() vines.simulate('b', -1, 'Omga', 2));
  assert(~isempty(strfind(message, 'did you mean Omega?')), message);
  problem = vines.problem();
  same(problem.status, 422);
  same({problem.errors.field}, {'b', 'Omga'});
  same(problem.errors(1).value, -1);
  same(problem.errors(1).range, [1e-9; 1000]);
  same(problem.errors(2).range, NaN);
end

function a_run_that_ends_early_gives_an_answer_and_a_warning()
  warning('error', 'vines:partialAnswer', 'local');
  message = refused('vines:partialAnswer', @() vines.simulate('max_impacts', 5));
  assert(~isempty(strfind(message, 'max_impacts: ')), message);
  warning('off', 'vines:partialAnswer', 'local');
  run = vines.simulate('max_impacts', 5);
  same(run.status.reason, 'max_impacts');
end

function a_sweep_passes_on_and_counts_its_points_as_they_arrive()
  global received
  received = [];
  [points, info] = vines.sweep(@note, 'axes', line(12), 'cycles', 50, 'base', struct('lambda', 1.4));
  same(received(:, 1)', 1:12);
  same(sort(received(:, 2))', 0:11);
  same([points.index], 0:11);
  same(size([points.lambda]), [4, 12]);
  same(info.start.parameters.lambda, 1.4);
  same([info.done, info.total, numel(info.missing)], [12, 12, 0]);
  assert(any(cellfun(@(w) ~isempty(strfind(w, 'depends on the start')), info.warnings)));
end

function note(point, info)
  global received
  received(end + 1, :) = [info.done, point.index];
  same(info.total, 12);
end

function points_with_different_keys_form_one_array()
  starts = {struct('x0', 0.001), struct('x0', 0.002)};
  points = vines.sweep('axes', {line(3), struct('parameter', 'lambda', 'values', [1.3, 1.4])}, ...
                       'starts', starts, 'cycles', 20, 'indices', [1, 5, 11]);
  same([points.index], [1, 5, 11]);
end

function a_continuation_has_points_special_points_and_branches()
  base = struct('b', 0.015, 'damping', 'closed_form');
  [points, specials, branches] = vines.continue_('base', base, 'parameter', 'b', 'from', 0.005, ...
                                                 'to', 0.02);
  assert(numel(points) > 50 && numel(branches) == 2);
  broken = specials(strcmp({specials.kind}, 'symmetry_breaking'));
  assert(abs(broken.b - 7.046736303e-3) < 1e-12);
end

function a_design_has_the_best_absorber_and_its_alternatives()
  machine = struct('m1', 2, 'f0', 8, 'damping_ratio', 0.01, 'm2', 0.04);
  tolerances.R.uniform = [0.35 0.45];
  [done, points, samples] = ...
    vines.design('base', machine, 'f', [7.8 8.2], 'acceleration', 5, 'R', 0.4, 'b_count', 3, ...
                 'f_count', 3, 'starts', 'one', 'cycles', 20, 'tolerances', tolerances, ...
                 'samples', 3, 'seed', 1);
  assert(any([points.x_max] == done.best.x_max));
  same(sort([samples.index]), 0:2);
  assert(abs(done.without.x_max - 0.0990) < 1e-4);
  assert(done.tuned_mass_damper.x_max < done.best.x_max);
end

function a_manifold_recommends_b()
  answer = vines.manifold('b', 0.02);
  assert(answer.manifold.recommended.b > 0);
end

function basins_have_points_and_a_result()
  base = struct('b', 0.0065, 'damping', 'closed_form', 'y0', 0);
  box = struct('x0', [-0.003 0.003], 'y_dot0', [-0.02 0.02]);
  [points, result] = vines.basins('base', base, 'box', box, 'count', 60, 'pairs', 0);
  same([points.index], 0:59);
  assert(numel(result.attractors) == 2);
  same(sort({result.attractors.attractor}), unique({points.attractor}));
  same(result.attractors(1).mirror, result.attractors(2).attractor);
end

function an_invalid_sweep_raises()
  refused('vines:problem', @() vines.sweep('axes', line(-3)));
  problem = vines.problem();
  same(problem.errors.field, 'axes/0/count');
end

function an_error_in_the_callback_stops_the_computation()
  refused('test:enough', @() vines.sweep(@enough, 'axes', line(4000), 'cycles', 20000));
  for wait = 1:6000
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

function an_interrupted_sweep_keeps_the_received_points()
  refused('vines:incomplete', @() vines.sweep(@end_it, 'axes', line(4000), 'cycles', 2000));
  problem = vines.problem();
  assert(numel(problem.points) > 0);
  same(sort([[problem.points.index], problem.missing]), 0:3999);
  rest = vines.sweep('axes', line(4000), 'cycles', 5, 'transient_cycles', 0, ...
                     'indices', problem.missing(1:3));
  same([rest.index], problem.missing(1:3));
end

function end_it(~, info)
  if info.done == 1
    rows = computing();
    system(sprintf('kill %d', sscanf(rows{1}, '%d', 1)));
  end
end

function rows = computing()
  % Processes that compute for this test; it runs the program under a unique name.
  [~, output] = system('ps -eo pid=,args= | grep -F "$TEST_FOLDER" | grep -E " sweep|curl" | grep -v grep');
  rows = strsplit(strtrim(output), sprintf('\n'));
  rows = rows(~cellfun('isempty', rows));
end

function a_file_and_its_columns_give_the_same_identification()
  table = dlmread(getenv('TEST_RECORD'), ',', 1, 0);
  columns = struct('time_s', table(:, 1), 'displacement_m', table(:, 2), ...
                   'acceleration_m_s2', table(:, 3));
  of_file = vines.identify(getenv('TEST_RECORD'), 'preset', 'fig20', 'b', 0.015);
  of_columns = vines.identify(columns, struct('preset', 'fig20', 'b', 0.015));
  assert(numel(of_file.impacts.tau) > 10);
  same(of_file.restitution, of_columns.restitution);
end

function impacts_of_a_run_are_accepted_as_a_measurement()
  run = vines.simulate('b', 0.015, 'R', 0.7, 'tau_end', 300, 'include', 'impacts');
  found = vines.identify([], 'impacts', run.impacts, 'b', 0.015);
  assert(abs(found.restitution.plus.R - 0.7) < 1e-9);
end

function lists_are_accepted_together_with_a_file()
  found = vines.identify(getenv('TEST_RECORD'), 'preset', 'fig20', 'b', 0.015, ...
                         'fixed', {'b', 'phase'}, 'phase', 0, 'include', 'motion');
  same(found.fitted.phase.fixed, true);
  same(isfield(found, 'motion'), true);
  refused('vines:arguments', @() vines.identify(getenv('TEST_RECORD'), 'record', struct('a', 1)));
end

function a_file_can_have_any_name_and_must_exist()
  folder = fullfile(getenv('TEST_FOLDER'), 'it''s $HOME "and" `more`; # ä \');
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

function no_temporary_files_remain()
  vines.simulate('tau_end', 20);
  vines.sweep('axes', line(2), 'cycles', 5);
  refused('vines:problem', @() vines.simulate('b', -1));
  same(numel(dir(getenv('TMPDIR'))), 2);
end

% Tests run once.

function service_and_program_give_the_same_numbers()
  answers = {};
  for way = {@use_service, @use_program}
    way{1}();
    answers{end + 1} = rmfield(vines.simulate('preset', 'fig11', 'tau_end', 300), 'provenance');
  end
  same(answers{:});
end

function a_design_that_ends_early_is_incomplete()
  path = fullfile(getenv('TEST_FOLDER'), 'stopped');
  file = fopen(path, 'w');
  fprintf(file, ['#!/bin/sh\ncat >/dev/null\necho ''{"type":"start"}''\n', ...
                 'echo ''{"type":"done","complete":false}''\necho "vines: stopped" >&2\nexit 3\n']);
  fclose(file);
  system(['chmod +x ', path]);
  program = getenv('VINES_PROGRAM');
  use_program(path);
  message = refused('vines:incomplete', @() vines.design('f', [7 9]));
  setenv('VINES_PROGRAM', program);
  same(message, 'stopped; received 0 points');
  problem = vines.problem();
  same(problem.status, 0);
end

function a_deadline_is_reported()
  use_locked_service(getenv('TEST_KEY'));
  warning('error', 'vines:partialAnswer', 'local');
  message = refused('vines:partialAnswer', ...
                 @() vines.simulate('b', 0.003, 'R', 1, 'tau_end', 1e7, 'max_impacts', 2000000, ...
                                    'include', 'exponents'));
  assert(~isempty(strfind(message, 'deadline: ')), message);
end

function the_key_is_sent_if_there_is_one()
  use_locked_service('');
  refused('vines:problem', @() vines.simulate('tau_end', 20));
  problem = vines.problem();
  same(problem.status, 401);
  use_locked_service(getenv('TEST_KEY'));
  run = vines.simulate('tau_end', 20);
  same(run.status.reason, 'tau_end');
  use_locked_service(sprintf('two\nlines'));
  refused('vines:arguments', @() vines.simulate('tau_end', 20));
end

function key_and_request_do_not_appear_in_the_process_list()
  use_locked_service(getenv('TEST_KEY'));
  global listed
  listed = '';
  % A number that no other process has in its arguments.
  base = struct('G', 0.0219876543);
  refused('test:enough', ...
          @() vines.sweep(@look, 'base', base, 'axes', line(4000), 'cycles', 20000));
  assert(~isempty(strfind(listed, 'curl -q --config')), 'curl does not run');
  assert(isempty(strfind(listed, getenv('TEST_KEY'))), 'the key is listed');
  assert(isempty(strfind(listed, '219876543')), 'the request is listed');
end

function look(~, ~)
  global listed
  [~, listed] = system('ps -eo args=');
  error('test:enough', 'enough');
end

function a_missing_service_and_a_missing_program_are_errors()
  setenv('VINES_URL', 'http://127.0.0.1:9');
  refused('vines:connection', @() vines.simulate('tau_end', 20));
  refused('vines:connection', @() vines.sweep('axes', line(3)));
  setenv('VINES_URL', 'ftp://127.0.0.1');
  refused('vines:arguments', @() vines.simulate('tau_end', 20));
  program = getenv('VINES_PROGRAM');
  use_program('no-such-program');
  message = refused('vines:program', @() vines.simulate('tau_end', 20));
  assert(~isempty(strfind(message, 'VINES_PROGRAM')), message);
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

both = {'a_run_has_lists_as_columns_and_parts_as_structs', ...
        'fields_are_pairs_or_a_struct_or_both', ...
        'a_single_value_is_sent_as_a_list_with_one_element', ...
        'numbers_are_exchanged_exactly', ...
        'null_is_nan_but_an_empty_list_is_not', ...
        'the_error_of_an_invalid_request_names_its_fields', ...
        'a_run_that_ends_early_gives_an_answer_and_a_warning', ...
        'a_sweep_passes_on_and_counts_its_points_as_they_arrive', ...
        'points_with_different_keys_form_one_array', ...
        'an_invalid_sweep_raises', ...
        'a_continuation_has_points_special_points_and_branches', ...
        'a_design_has_the_best_absorber_and_its_alternatives', ...
        'basins_have_points_and_a_result', ...
        'a_manifold_recommends_b', ...
        'an_error_in_the_callback_stops_the_computation', ...
        'an_interrupted_sweep_keeps_the_received_points', ...
        'a_file_and_its_columns_give_the_same_identification', ...
        'impacts_of_a_run_are_accepted_as_a_measurement', ...
        'lists_are_accepted_together_with_a_file', ...
        'a_file_can_have_any_name_and_must_exist', ...
        'no_temporary_files_remain'};
one = {'service_and_program_give_the_same_numbers', ...
       'a_design_that_ends_early_is_incomplete', ...
       'a_deadline_is_reported', ...
       'the_key_is_sent_if_there_is_one', ...
       'key_and_request_do_not_appear_in_the_process_list', ...
       'a_missing_service_and_a_missing_program_are_errors'};
failed = 0;
for k = 1:numel(both)
  use_service();
  failed = failed + tried(both{k}, ', with a service');
  use_program();
  failed = failed + tried(both{k}, ', with the program');
end
for k = 1:numel(one)
  setenv('VINES_KEY', '');
  failed = failed + tried(one{k}, '');
end
fprintf('%d failed\n', failed);
exit(double(failed > 0));
