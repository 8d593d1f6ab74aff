function lines = completed_lines(request)
  % The lines of a stream, as received_lines.m; raises vines:incomplete if it ended early.
  [lines, outcome] = vines.internal.received_lines(request);
  last = lines{end};
  if ~strcmp(last.type, 'done') || (isfield(last, 'complete') && ~last.complete)
    outcome.status = 0;
    if strcmp(last.type, 'error')
      outcome.status = last.status;
      outcome.message = last.detail;
    end
    points = vines.internal.of_type(lines, 'point');
    detail = sprintf('received %d points', numel(points));
    if ~isempty(outcome.message)
      detail = [outcome.message, '; ', detail];
    end
    vines.internal.raise('incomplete', outcome, detail, struct('points', points, 'missing', []));
  end
end
