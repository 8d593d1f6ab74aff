function is = asks_service()
  % Whether a service is named; else the program answers.
  is = ~isempty(getenv('VINES_URL'));
end
