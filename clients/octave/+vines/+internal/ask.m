function answer = ask(request)
  % The answer to a request that has one.
  [folder, cleaner] = vines.internal.room(); %#ok<ASGLU>
  code = vines.internal.shell(folder, vines.internal.command(folder, request));
  told = vines.internal.ended(folder, code);
  text = vines.internal.content(fullfile(folder, 'out'));
  if vines.internal.asks_service()
    is_answer = told.code == 0 && told.status == 200;
  else
    is_answer = any(told.code == [0, 3]) && ~isempty(text);
  end
  if ~is_answer
    vines.internal.refuse(told, text);
  end
  answer = vines.internal.decode(text);
end
