function answer = send(request)
  % Sends REQUEST (see command.m) and returns the decoded answer. Raises an error if it is refused.
  [folder, cleaner] = vines.internal.request_folder(); %#ok<ASGLU>
  code = vines.internal.run_script(folder, vines.internal.command(folder, request));
  outcome = vines.internal.outcome_of(folder, code);
  text = vines.internal.content(fullfile(folder, 'out'));
  if vines.internal.uses_service()
    is_answer = outcome.code == 0 && outcome.status == 200;
  else
    is_answer = any(outcome.code == [0, 3]) && ~isempty(text);
  end
  if ~is_answer
    vines.internal.refuse(outcome, text);
  end
  answer = vines.internal.decode(text);
end
