function lines = completed_lines(request)
  % The lines of a stream, as received_lines.m; raises vines:incomplete if it ended early.
  [lines, outcome] = vines.internal.received_lines(request);
  if ~strcmp(lines{end}.type, 'done')
    if strcmp(lines{end}.type, 'error')
      outcome.message = lines{end}.detail;
    end
    points = vines.internal.of_type(lines, 'point');
    detail = sprintf('%s; received %d points', outcome.message, numel(points));
    vines.internal.raise('incomplete', outcome, detail, struct('points', points, 'missing', []));
  end
end
