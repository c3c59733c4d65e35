# Takes the blocks of code out of a page in Markdown: block.N holds the text, block.N.about three kinds of lines,
#   language WORD, line N, and the notes <!-- KEY: VALUE --> that stand right above the block, as KEY: VALUE
# A note <!-- all KEY: VALUE --> holds for all blocks that follow.
function start(word) {
  n++
  text = "block." n
  about = text ".about"
  print "language " (word == "" ? "none" : word) >about
  print "line " NR >about
  printf "%s%s", all, notes >about
  close(about)
  printf "" >text
}
inside {
  if ($0 ~ /^```/) { inside = 0; close(text) } else print >text
  next
}
/^```/ { start(substr($0, 4)); notes = ""; inside = 1; next }
/^<!-- .* -->$/ {
  note = substr($0, 6, length($0) - 9)
  if (sub(/^all /, "", note)) all = all note "\n"; else notes = notes note "\n"
  next
}
# a block by indentation is none of a list, and stands after an empty line
/^    [^ ]/ && empty { start("indented"); indented = 1 }
/^    / && indented { print substr($0, 5) >text; empty = 0; next }
{ if (indented) { indented = 0; close(text) } }
/^$/ { empty = 1; next }
{ empty = 0; notes = "" }
