# limber's plain comments as doxygen reads them: those above a declaration, and those at the end of a line. The first of a file are the
# file's own. What looks like a command or a tag is escaped.
function escaped(text) { gsub(/#[A-Za-z]/, "\\\\&", text); gsub(/</, "\\<", text); gsub(/@/, "\\@", text); return text }
NR == 1 && /^\/\/ / { print "/// \\file" }
/^ *\/\/( |$)/ { sub(/\/\//, "///"); print escaped($0); next }
/; {1,}\/\/ / { at = index($0, "// "); print substr($0, 1, at - 1) "///< " escaped(substr($0, at + 3)); next }
{ print }
