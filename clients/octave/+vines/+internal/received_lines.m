function [lines, outcome] = received_lines(request)
  % Sends REQUEST (see command.m), waits for the end of the answer and returns its lines, decoded.
  % Raises an error if the request is refused.
  [folder, cleaner] = vines.internal.request_folder(); %#ok<ASGLU>
  code = vines.internal.run_script(folder, vines.internal.command(folder, request));
  outcome = vines.internal.outcome_of(folder, code);
  text = vines.internal.content(fullfile(folder, 'out'));
  whole = find(text == 10, 1, 'last');
  refused = vines.internal.uses_service() && outcome.status ~= 200;
  if isempty(whole) || refused
    vines.internal.refuse(outcome, text);
  end
  lines = strsplit(text(1:whole - 1), sprintf('\n'));
  lines = cellfun(@vines.internal.decode, lines, 'UniformOutput', false);
end
