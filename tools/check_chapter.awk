# Rules for a chapter in Markdown; see check_style.
BEGIN {
  REFUSED = "who answered|nobody listens|every solver is told|" \
    "(^|[^a-z])(anew|at hand|foreseen|asks for|calls for|the truth)([^a-z]|$)"
}

function fail(text) {
  printf "%s:%d: %s\n", FILENAME, FNR, text
  ++bad
}

FNR == 1 && !/^# ./ { fail("no title in the first line") }
/^```/ { code = !code }
/[ \t\r]$/ { fail("blank at the end of the line") }
/(^|[^A-Za-z0-9_.])\/(work|root|home|Users)\// { fail("path of a machine") }
tolower($0) ~ REFUSED { fail("a word that is no term of the field") }
!code && !/^\|/ && !/^!/ && length($0) > 100 { fail("line over 100 columns") }
!code {
  rest = $0
  while (match(rest, /\]\([^):#]*\)/)) {
    link = folder substr(rest, RSTART + 2, RLENGTH - 3)
    rest = substr(rest, RSTART + RLENGTH)
    if (system("test -e '" link "'") != 0) fail("no file " link)
  }
}
END {
  if (code) fail("block not closed")
  exit bad > 0
}
