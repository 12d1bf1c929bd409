# Rules for the C sources of one folder; see check_style. Reads headers first.
#
# Text is cut into characters once: comments and literals are blanked, macro
# definitions skipped, and what is left at brace depth 0 is collected into
# declarations.

BEGIN {
  MAX_COLUMNS = 80; MAX_LINES = 800; MAX_FILES = 10; MAX_PARAMETERS = 7
  SHORT = 20; LONG = 80; MAX_FUNCTION = 150; MAX_COMPLEXITY = 15
  MAX_FIELDS = 25
  # Words that are no terms of the field; more of them in src.
  REFUSED = "who answered|nobody listens|every solver is told|" \
    "(^|[^a-z_])(anew|at hand)([^a-z_]|$)"
  if (folder ~ /(^|\/)src$/)
    REFUSED = REFUSED "|(^|[^a-z_])(beside|judged?|judges|led|stranger|" \
      "asks for|asked for|as long as|worth a try)([^a-z_]|$)"
  is_source = folder ~ /(^|\/)src$/
}

function fail(line, text) {
  printf "%s:%d: %s\n", file, line, text
  ++bad
}

FNR == 1 {
  if (NR > 1) end_file()
  begin_file()
}

{
  plain_rules()
  code = blank_comments($0)
  if (has_comment) comment_rules()
  if (in_macro || code ~ /^[ ]*#/) {
    if (!in_macro) directive(code)
    in_macro = $0 ~ /\\$/
    code = ""
  }
  scan(code)
  code_line = code ~ /[^ ]/
  if (is_header) header_line()
}

END {
  if (NR > 0) end_file()
  totals()
  exit bad > 0
}

# ---- lines -----------------------------------------------------------------

function plain_rules(    visible) {
  visible = $0
  gsub(/[\200-\277]/, "", visible)
  if (length(visible) > MAX_COLUMNS) fail(FNR, "line over 80 columns")
  if ($0 ~ /\t/) fail(FNR, "tab")
  if ($0 ~ /[ \t\r]$/) fail(FNR, "blank at the end of the line")
  if ($0 ~ /(^|[^A-Za-z0-9_.])\/(work|root|home|Users)\//)
    fail(FNR, "path of a machine")
  if (tolower($0) ~ REFUSED) fail(FNR, "a word that is no term of the field")
  if (is_source && $0 ~ /[^ ]  +\*\/( *\\)?$/)
    fail(FNR, "blanks before the end of a comment")
}

function comment_rules(    text) {
  text = comment
  sub(/^[ *]+/, "", text)
  sub(/[ ]+$/, "", text)
  if (text ~ /^(if|for|while|switch) *\(.*[;{]$/ ||
      text ~ /^(return|static|const|int|double|char|void|struct|else|break|continue)[^A-Za-z].*[;{]$/ ||
      text ~ /^#(include|define|if|endif)/ ||
      text ~ /^[A-Za-z_][A-Za-z0-9_.>\[\]-]*\(.*\);$/ ||
      (text ~ /^[A-Za-z_][A-Za-z0-9_.>\[\]-]* *[-+*\/]?= .*;$/ &&
       text !~ /[a-z] [A-Za-z_]+ [a-z]/))
    fail(FNR, "code in a comment")
}

# The line with comments and literals blanked; "comment" gets their text.
function blank_comments(line,    out, i, c, two, n) {
  out = ""; comment = ""; has_comment = in_comment; n = length(line)
  if (!in_comment && line !~ /["'\/]/) return line
  for (i = 1; i <= n; ++i) {
    c = substr(line, i, 1); two = substr(line, i, 2)
    if (in_comment) {
      if (two == "*/") { in_comment = 0; ++i } else comment = comment c
    } else if (quote != "") {
      if (c == "\\") ++i
      else if (c == quote) { quote = ""; out = out "0" }
    } else if (two == "/*") {
      in_comment = has_comment = 1; ++i
    } else if (two == "//") {
      has_comment = 1; comment = substr(line, i + 2); break
    } else if (c == "\"" || c == "'") quote = c
    else out = out c
  }
  quote = ""
  return out
}

function directive(text) {
  if (text ~ /^[ ]*#[ ]*if[ ]+0([^-0-9A-Za-z.]|$)/) fail(FNR, "#if 0")
  if (!is_header) return
  if (text ~ /^#pragma once$/) once = 1
}

# ---- declarations and functions --------------------------------------------

# One line of code, cut at the tokens that open, close and end things.
function scan(text,    token) {
  while (match(text, /[A-Za-z_0-9.]+|&&|\|\||[{};?]|[^ ]/)) {
    token = substr(text, RSTART, RLENGTH)
    text = substr(text, RSTART + RLENGTH)
    if (token == "{") open_brace()
    else if (token == "}") close_brace()
    else if (depth == 0 && token == ";") end_declaration()
    else if (depth == 0) {
      if (declaration == "") declared_at = FNR
      declaration = declaration (declaration == "" ? "" : " ") token
    } else if (in_function) body_token(token)
    else if (in_struct && depth == 1) field_token(token)
  }
}

function open_brace() {
  if (collecting) body_token("=")
  if (depth++ > 0) return
  in_function = declaration ~ /\)$/ && declaration !~ /=/
  if (in_function) begin_function()
  in_struct = declaration ~ /^(typedef )?struct( [A-Za-z_0-9]+)?$/
  fields = parentheses = 0
}

function close_brace() {
  if (--depth > 0) return
  if (in_function) { end_function(); declaration = "" }
  if (in_struct && is_source && fields > MAX_FIELDS)
    fail(declared_at, declaration ": " fields " fields, expected at most 25")
  in_function = in_struct = 0
}

# What stands in braces within is one field.
function field_token(token) {
  if (token == "(") ++parentheses
  else if (token == ")") --parentheses
  else if (token == ";" || (token == "," && parentheses == 0)) ++fields
}

function body_token(token) {
  if (token ~ /^(if|for|while|case|\?|&&|\|\|)$/) ++complexity
  if (token == "static") { collecting = 1; kept = "" }
  else if (collecting && token ~ /^[=;]$/) {
    collecting = 0
    if (is_source && !is_base && !is_constant(kept))
      fail(FNR, "static variable that can change")
  } else if (collecting) kept = kept " " token
}

# Parameters between the first parenthesis and its partner.
function count_parameters(text,    level, n, i, c, inner) {
  sub(/^[^(]*/, "", text)
  n = 1
  for (i = 1; i <= length(text); ++i) {
    c = substr(text, i, 1)
    if (c == "(") ++level
    else if (c == ")" && --level == 0) break
    else if (c == "," && level == 1) ++n
    inner = inner c
  }
  return inner ~ /^\( *(void)? *$/ ? 0 : n
}

function declared_name(text) {
  sub(/ *\(.*/, "", text)
  sub(/.*[ *]/, "", text)
  return text
}

function begin_function() {
  name = declared_name(declaration)
  start = declared_at
  complexity = 1
  collecting = 0
  if (count_parameters(declaration) > MAX_PARAMETERS)
    fail(start, name ": over 7 parameters")
  if (!is_header && declaration !~ /^static / && name != "main" &&
      name !~ /^[A-Z_]+$/ && !(name in exported))
    fail(start, name ": neither static nor in a header")
}

function end_function(    length_) {
  length_ = FNR - start + 1
  ++functions
  if (length_ < SHORT) ++short_functions
  if (length_ >= LONG) long_list = long_list sprintf("  %s:%d: %s, %d lines\n", file, start, name, length_)
  if (length_ >= LONG) ++long_functions
  if (length_ > MAX_FUNCTION) fail(start, name ": over 150 lines")
  if (complexity >= MAX_COMPLEXITY)
    fail(start, name ": cyclomatic complexity " complexity ", expected under 15")
}

function end_declaration(    text, before_value, word, i) {
  text = declaration
  declaration = ""
  if (text ~ /^typedef [^(]* \( [^*]/) function_type[declared_name(text)] = 1
  if (text == "" || text ~ /^typedef / || text ~ /^_Static_assert/) return
  if (split(text, word, /[ ,]+/) > 1 && word[1] in function_type) {
    for (i in word) exported[word[i]] = 1
    return
  }
  before_value = text
  sub(/ *=.*/, "", before_value)
  if (before_value ~ /\(/) {
    if (is_header) prototype(text)
    return
  }
  if (text ~ /^(struct|union|enum)( [A-Za-z_0-9]+)?$/) return
  if (is_source && !is_base && !is_constant(before_value))
    fail(declared_at, "variable of the file that can change")
}

function is_constant(text) {
  if (text ~ /\( \* const /) return 1
  if (text ~ /\*/) return text ~ /\* const [^*]*$/
  return text ~ /(^| )const /
}

function prototype(text) {
  exported[declared_name(text)] = 1
  if (count_parameters(text) > MAX_PARAMETERS)
    fail(declared_at, declared_name(text) ": over 7 parameters")
  block_name[++block] = declared_name(text)
  block_line[block] = declared_at
}

# A block of lines without an empty one between is documented by a comment in it.
function header_line() {
  if (has_comment) block_comment = 1
  if ($0 ~ /^$/) end_block()
}

function end_block(    i) {
  if (!block_comment)
    for (i = 1; i <= block; ++i)
      fail(block_line[i], block_name[i] ": exported without a comment")
  block = block_comment = 0
}

# ---- files -----------------------------------------------------------------

function begin_file(    path) {
  file = FILENAME
  is_header = file ~ /\.h$/
  is_base = file ~ /(^|\/)src\/(base|system)\//
  depth = in_comment = in_macro = in_function = in_struct = once = 0
  block = block_comment = 0
  declaration = ""
  path = file
  sub(/\/[^\/]*$/, "", path)
  if (!is_header) ++in_folder[path]
}

function end_file() {
  lines = last_line
  if (lines > MAX_LINES) fail(lines, "file over 800 lines")
  if (depth != 0) fail(lines, "braces do not match")
  if (!is_header) return
  end_block()
  if (!once) fail(1, "#pragma once missing")
}

{ last_line = FNR }

function totals(    path) {
  file = folder
  if (is_source)
    for (path in in_folder)
      if (in_folder[path] > MAX_FILES)
        printf "%s: %d .c files, expected at most 10\n", path, in_folder[path]
  if (is_source)
    for (path in in_folder) bad += in_folder[path] > MAX_FILES
  if (functions == 0) return
  if (2 * short_functions < functions) {
    printf "%s: %d of %d functions under 20 lines, expected half\n", folder,
      short_functions, functions
    ++bad
  }
  if (20 * long_functions > functions) {
    printf "%s: %d of %d functions of 80 lines or more, expected 5 %%:\n%s",
      folder, long_functions, functions, long_list
    ++bad
  }
}
