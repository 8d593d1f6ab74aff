function text = quoted(text)
  % A word of a command of the shell.
  text = ['''', strrep(text, '''', '''\'''''), ''''];
end
