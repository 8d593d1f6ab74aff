function is = uses_service()
  % True if VINES_URL names a service; otherwise the program computes the answer.
  is = ~isempty(getenv('VINES_URL'));
end
