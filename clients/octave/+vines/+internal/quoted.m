function text = quoted(text)
  % TEXT as one word of a shell command.
  text = ['''', strrep(text, '''', '''\'''''), ''''];
end
