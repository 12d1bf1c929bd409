/* src/deck: the grammar of the deck, good and wrong; each wrong deck with the
 * first line it is answered with. */
#include "support/decks.h"
#include "support/unit.h"

#include <sys/stat.h>

/* ---- good decks -------------------------------------------------------- */

typedef struct good_deck {
  const char *text, *shape;
} good_deck;

/* clang-format off */
static const good_deck good_decks[] = {
  /* Free format, case, blanks, tabs, CR LF, mark, no last newline. */
  {"*STEP", "*STEP"},
  {"\xEF\xBB\xBF*STEP\n", "*STEP"},
  {"*step\r\n*End  \t Step\r\n", "*STEP*END STEP"},
  {"  *Solid\tSection ,elset = Body,  Material=Steel  \n",
   "*SOLID SECTION{ELSET=Body}{MATERIAL=Steel}"},
  {"*A\r1,2\r*B\r", "*A[1|2]*B"},
  {"*A\n 1. ,\t.5 , x y \n\n   \n3\n", "*A[1.|.5|x y][3]"},
  {"*A, NO  VALUE, B=2\n", "*A{NO VALUE}{B=2}"},
  {"*A\n,,3\n1,,\n*B", "*A[||3][1|]*B"},
  /* Comments. */
  {"** first\n*A ** behind\n** between\n1, 2 ** behind\n  ** blank before\n3\n",
   "*A[1|2][3]"},
  {"*A\n1,2**close\n*** three\n\"x**2\"\n", "*A[1|2][\"x**2\"]"},
  {"*A, B=c**d\n", "*A{B=c}"},
  /* Lines that go on. */
  {"*A,\nB=1,\n  C=2\n1,\n2\n", "*A{B=1}{C=2}[1|2]"},
  {"*A, ** comment\n** another\n\nB=1\n", "*A{B=1}"},
  {"*A\n1,2,\n3,4, ** more\n5\n6\n", "*A[1|2|3|4|5][6]"},
  {"*A\n1,2,\n*B\n1,\n", "*A[1|2]*B[1]"},
  /* Quotes. */
  {"*A\n\"x*max(y,2)\", 2\n", "*A[\"x*max(y,2)\"|2]"},
  {"*A, F=\"a b,c.msh\", G=\"1+1\"\n", "*A{F=a b,c.msh}{G=2}"},
  {"*PARAMETER\nN=-2\n*A, F=\"a <N>,b.msh\", G=\"<N>^2\", H=\"N\"\n",
   "*A{F=a -2,b.msh}{G=4}{H=N}"},
  {"*A\n\"2*3\",\" x \"\n", "*A[\"6\"|\"x\"]"},
  {"*A, B=\"p=q\"\n", "*A{B=p=q}"},
  /* Headings. */
  {"*HEADING\nA \"title, <no> name,\n ** comment\n  2 ** text\n*A\n",
   "*HEADING[A \"title, <no> name,][2 ** text]*A"},
  {"*PARAMETER\nN=3\n*HEADING\nN is <N>\n", "*HEADING[N is 3]"},
  /* Names. */
  {"*PARAMETER\nH = 0.05\nN = <H>*2\n*A, B=<N>, C=m<h>.geo\n<H>, -<N>, <n>\n",
   "*A{B=0.1}{C=m0.05.geo}[0.05|-0.1|0.1]"},
  {"*PARAMETER\nH=1/3\n*A\n<H>\n", "*A[0.3333333333333333]"},
  {"*PARAMETER\nA=1+1, B=max(A,\n 7), C=A^2\n*X\n<A>,<B>,<C>\n",
   "*X[2|7|4]"},
  {"*PARAMETER\nA=1.5E+03\nB=3+1\nC=1.D3\nD= -2\n*X\n<A>,<B>,<C>,-<D>,+<D>\n",
   "*X[1500|4|1000|2|-2]"},
  {"*PARAMETER\nD=-2\n*X\n\"x^2-<D>\", \"<D>^2\", \"D^2\",\"0<x\"\n",
   "*X[\"x^2-(-2)\"|\"4\"|\"4\"|\"0<x\"]"},
  {"*PARAMETER\nK=2 ** two\nM=3, ** of them\n*X\n<K>,<M>\n", "*X[2|3]"},
  {"*PARAMETER\n_a1 = \"2*3\"\n*X\n<_A1>,a<b,c>d,<>,< A>\n",
   "*X[6|a<b|c>d|<>|< A>]"},
  {"*PARAMETER\nA = 2.5 -1, B = \"2.5-1\"\n*A\n<A>,<B>\n", "*A[1.5|1.5]"},
  /* Fixed columns. */
  {"*LEGACY, FORMAT=(I5,3F10.0)\n*A\n    1       2.5     1.D-1      -3."
   "\n    2        7.\n",
   "*A[1|2.5|1.D-1|-3.][2|7.]"},
  {"*LEGACY, FORMAT=(A4,F6.2,2(I2,1X),E8.3)\n*A\nTOP   1234 1  2 15E2\n"
   "*B\n1,2\n", "*A[TOP|12.34|1|2|.015E2]*B[1|2]"},
  {"*legacy, format=( 2X , 2( i1 , 2( 1X , a1 ) ) )\n*A\nzz1 a b2 c d\n",
   "*A[1|a|b|2|c|d]"},
  {"*LEGACY, FORMAT=(A2,I2,F3.1,E3.1,D3.1,G3.1,1X,i1,d4.1)\n*A\n"
   "AB 1 21 32 43 54 6 1D1\n", "*A[AB|1|2.1|3.2|4.3|5.4|6|.1D1]"},
  {"*LEGACY, FORMAT=(3F4.3)\n*A\n   1       3\n  -1\n +12\n",
   "*A[.001|0|.003][-.001][+.012]"},
  {"*LEGACY, FORMAT=(F6.0,F6.2)\n*A\n 1.5-3  15+2\n1.5+03\n",
   "*A[1.5E-3|.15E+2][1.5E+03]"},
  {"*PARAMETER\nH=3\n*LEGACY, FORMAT=(2F5.1)\n*A\n <H>    20\n",
   "*A[3|2.0]"},
  {"*LEGACY,\n FORMAT=(I5,\n F10.0)\n*A\n    1        2.\n", "*A[1|2.]"},
  {"*LEGACY, FORMAT=\"(I5,F10.0)\"\n*A\n    1        2.\n", "*A[1|2.]"},
};
/* clang-format on */

TEST(good_decks_have_their_cards) {
  decks_enter();
  for (size_t i = 0; i < sizeof good_decks / sizeof *good_decks; ++i) {
    read_deck r = decks_read_good(good_decks[i].text);
    ck_assert_msg(strcmp(decks_shape(r.d), good_decks[i].shape) == 0,
                  "%s\ngives %s\nnot   %s", good_decks[i].text,
                  decks_shape(r.d), good_decks[i].shape);
    decks_done(&r);
  }
  decks_leave();
}

/* ---- wrong decks ------------------------------------------------------- */

typedef struct wrong_deck {
  const char *text, *first, *totals;
} wrong_deck;

/* clang-format off */
static const wrong_deck wrong_decks[] = {
  {"", "a.inp: error P1002: no card in the file", "1 error"},
  {"** only\n\n", "a.inp: error P1002: no card in the file", "1 error"},
  {"1,2\n3\n*A\n4\n", "a.inp:1:1: error P1015: data before the first card",
   "1 error"},
  {"*\n1,2\n", "a.inp:1:1: error P1009: a card without a name", "1 error"},
  {"*A\n *  , B\n", "a.inp:2:2: error P1009: a card without a name",
   "1 error"},
  {"*ELASTIC TYPE=ISO\n1,2\n",
   "a.inp:1:14: error P1010: an equals sign in the name of a card; is a comma "
   "missing before?", "1 error"},
  {"*A, B=1 C=2\n", "a.inp:1:10: error P1010: a second equals sign; is a comma "
   "missing before?", "1 error"},
  {"*A, B=1, C=2, b=3, B\n", "a.inp:1:15: error P1005: B is repeated",
   "2 errors"},
  {"*A, B=\n", "a.inp:1:6: error P1007: B has no value", "1 error"},
  {"*A, B= , C=1\n", "a.inp:1:6: error P1007: B has no value", "1 error"},
  {"*A, , B\n", "a.inp:1:5: error P1008: an empty parameter between commas",
   "1 error"},
  {"*A, =1\n", "a.inp:1:5: error P1008: no name before the equals sign",
   "1 error"},
  {"*A, B,\n*C\n",
   "a.inp:1:6: error P1016: the card ends in a comma and does not go on",
   "1 error"},
  {"*A, ** x\n",
   "a.inp:1:3: error P1016: the card ends in a comma and does not go on",
   "1 error"},
  {"*A\n1, \"x+1\n", "a.inp:2:4: error P1011: quote not closed", "1 error"},
  {"*A, B=\"x\n", "a.inp:1:7: error P1011: quote not closed", "1 error"},
  {"*A\n\"x\"y, 1\n", "a.inp:2:4: error P1012: text next to a quoted value",
   "1 error"},
  {"*A\nu\"x\", 1\n", "a.inp:2:2: error P1012: text next to a quoted value",
   "1 error"},
  {"*A\n\"x\"\"y\", 1\n", "a.inp:2:4: error P1012: text next to a quoted value",
   "1 error"},
  /* Names. */
  {"*A\n1, <H>\n", "a.inp:2:4: error P1020: unknown name <H>", "1 error"},
  {"*PARAMETER\nHEIGHT=1\n*A, B=<HIGHT>\n",
   "a.inp:3:7: error P1020: unknown name <HIGHT>; did you mean <HEIGHT>?",
   "1 error"},
  {"*A\n<H>\n*PARAMETER\nH=1\n", "a.inp:2:1: error P1020: unknown name <H>",
   "1 error"},
  {"*A\n1, \"x*<H>\"\n", "a.inp:2:7: error P1020: unknown name <H>",
   "1 error"},
  {"*PARAMETER\nN=32\n*A\n<N>-1\n",
   "a.inp:4:1: error P1036: '<N>-1' becomes '32-1', a number with exponent",
   "1 error"},
  {"*PARAMETER\nA = 2.5-1\n*A\n",
   "a.inp:2:5: error P1036: '2.5-1' is a sum and a number with exponent; write "
   "E before the exponent, or a blank before the sign of a sum", "1 error"},
  {"*PARAMETER\nfoo\n*A\n", "a.inp:2:1: error P1019: NAME = VALUE expected",
   "1 error"},
  {"*PARAMETER\n=3\n*A\n",
   "a.inp:2:1: error P1019: no name before the equals sign", "1 error"},
  {"*PARAMETER\nA=\n*A\n",
   "a.inp:2:1: error P1019: no value after the equals sign", "1 error"},
  {"*PARAMETER\nA=\"\"\n*A\n",
   "a.inp:2:1: error P1019: no value after the equals sign", "1 error"},
  {"*PARAMETER\nA==2\n*A\n", "a.inp:2:1: error P1019: one equals sign expected",
   "1 error"},
  {"*PARAMETER\n2A=2\n*A\n", "a.inp:2:1: error P1019: a name is a letter "
   "followed by letters, digits and underscores", "1 error"},
  {"*PARAMETER\nA B=2\n*A\n", "a.inp:2:1: error P1019: a name is a letter "
   "followed by letters, digits and underscores", "1 error"},
  {"*PARAMETER\nA=1\na=2\n*A\n",
   "a.inp:3:1: error P1021: A is defined already, in a.inp:2", "1 error"},
  {"*PARAMETER\nA = 1 + foo\n*A\n<A>\n",
   "a.inp:2:9: error P1022: unknown name FOO in expression '1 + foo'",
   "1 error"},
  {"*PARAMETER\nWIDTH=2\nA = 2*widht\n*A\n",
   "a.inp:3:7: error P1022: unknown name WIDHT in expression '2*widht'; "
   "did you mean WIDTH?", "1 error"},
  {"*PARAMETER\nN=2\nA = <N>*foo\n*A\n",
   "a.inp:3:5: error P1022: unknown name FOO in expression '2*foo'", "1 error"},
  {"*PARAMETER\nA = 2*(3\n*A\n",
   "a.inp:2:7: error P1022: '(' is not closed in expression '2*(3'", "1 error"},
  {"*PARAMETER\nA = t*2\n*A\n", "a.inp:2:5: error P1022: 't*2' depends on x, "
   "y, z or t; a parameter of that name is written <NAME>", "1 error"},
  {"*PARAMETER\nA = 1/0\n*A\n", "a.inp:2:5: error P1023: '1/0' is not finite",
   "1 error"},
  {"*PARAMETER\nA = sqrt(-1)\n*A\n",
   "a.inp:2:5: error P1023: 'sqrt(-1)' is not finite", "1 error"},
  {"*PARAMETER\nA = nan\n*A\n",
   "a.inp:2:5: error P1022: unknown name NAN in expression 'nan'", "1 error"},
  {"*PARAMETER\nA = 0x10\n*A\n", "a.inp:2:5: error P1022: hexadecimal is not "
   "accepted: '0x10' in expression '0x10'", "1 error"},
  {"*PARAMETER\nT = 1\n*A\n<T>\n", "a.inp:2:1: warning P1034: T keeps its own "
   "meaning in expressions; the value is <T>", "1 warning"},
  {"*PARAMETER\nA = 2**3\n*A\n",
   "a.inp:2:6: error P1035: ** starts a comment; a power is written ^",
   "1 error"},
  {"*PARAMETER\nN=2\nA = 2 ** N\n*A\n",
   "a.inp:3:7: error P1035: ** starts a comment; a power is written ^",
   "1 error"},
  {"*PARAMETER\nN=2\nA = 2 ** sqrt(4)\n*A\n",
   "a.inp:3:7: error P1035: ** starts a comment; a power is written ^",
   "1 error"},
  {"*PARAMETER\nN=2\nA = 2 ** (1+1)\n*A\n",
   "a.inp:3:7: error P1035: ** starts a comment; a power is written ^",
   "1 error"},
  {"*PARAMETER\nN=2\nA = 2 ** .5\n*A\n",
   "a.inp:3:7: error P1035: ** starts a comment; a power is written ^",
   "1 error"},
  {"*PARAMETER\nN=2\nA = 2 ** <N>\n*A\n",
   "a.inp:3:7: error P1035: ** starts a comment; a power is written ^",
   "1 error"},
  {"*PARAMETER, B=1\n*A\n",
   "a.inp:1:13: error P2003: unknown parameter B of *PARAMETER", "1 error"},
  /* Includes. */
  {"*INCLUDE\n*A\n", "a.inp:1:1: error P2005: *INCLUDE needs INPUT=VALUE",
   "1 error"},
  {"*INCLUDE, INPT=b.inp\n*A\n", "a.inp:1:11: error P2003: unknown parameter "
   "INPT of *INCLUDE; did you mean INPUT?", "1 error"},
  {"*INCLUDE, INPUT\n*A\n",
   "a.inp:1:1: error P1007: *INCLUDE needs INPUT=VALUE", "1 error"},
  {"*INCLUDE, INPUT=none.inp\n*A\n", "a.inp:1:17: error P1001: cannot read "
   "none.inp: No such file or directory", "1 error"},
  {"*INCLUDE, INPUT=.\n*A\n",
   "a.inp:1:17: error P1001: cannot read .: it is a folder", "1 error"},
  {"*A\n*INCLUDE, INPUT=a.inp\n",
   "a.inp:2:17: error P1017: a.inp includes itself", "1 error"},
  {"*A\n*INCLUDE, INPUT=./a.inp\n",
   "a.inp:2:17: error P1017: ./a.inp includes itself", "1 error"},
  /* Fixed columns. */
  {"*LEGACY\n*A\n", "a.inp:1:1: error P2005: *LEGACY needs FORMAT=VALUE",
   "1 error"},
  {"*A\n*LEGACY, FORMAT=(I5)\n",
   "a.inp:2:1: error P1031: no card with data follows", "1 error"},
  {"*LEGACY, FORMAT=(I5)\n*LEGACY, FORMAT=(I6)\n*A\n",
   "a.inp:1:1: error P1031: no card with data follows", "1 error"},
  {"*LEGACY, FORMAT=(I5)\n1\n2\n*A\n",
   "a.inp:2:1: error P2008: the card above takes no data lines", "1 error"},
  {"*LEGACY, FORMAT=(I5)\n*A\n  1.0\n",
   "a.inp:3:3: error P1028: not an integer in columns 1-5: '1.0'", "1 error"},
  {"*LEGACY, FORMAT=(I2,F5.0)\n*A\n 1 1 2 \n", "a.inp:3:4: error P1028: "
   "characters after the number in columns 3-7: '1 2'", "1 error"},
  {"*LEGACY, FORMAT=(F5.0)\n*A\n 1.0 x\n 2.0 x\n", "a.inp:3:6: warning P1030: "
   "text after column 5 is not read", "1 warning"},
  {"*LEGACY, FORMAT=(A2,A9)\n*A\n 1\t0\n",
   "a.inp:3:3: error P1029: a tab in fixed columns", "1 error"},
};

/* Formats: what is wrong with each. */
static const char *const wrong_formats[][2] = {
  {"I5", "'(' expected at the start"},
  {"(I5", "')' missing at the end"},
  {"(I5))", "text after the last ')'"},
  {"()", "I, F, E, D, G, A or X expected at character 2"},
  {"(I5,)", "I, F, E, D, G, A or X expected at character 5"},
  {"(Q5)", "I, F, E, D, G, A or X expected at character 2"},
  {"(I)", "I without a width"},
  {"(A)", "A without a width"},
  {"(I0)", "I without a width"},
  {"(0I5)", "a repeat count of zero"},
  {"(I5 I5)", "a comma is missing at character 5"},
  {"(I5000)", "more than 4096 columns"},
  {"(999999999999999999999I5)", "more than 4096 columns"},
  {"(1000(1000(1000(1000(I5)))))", "more than 4096 columns"},
  {"(((((((((I5)))))))))", "groups more than 8 deep"},
  {"(2(2(2())))", "I, F, E, D, G, A or X expected at character 8"},
  {"(1PE12.4)", "I, F, E, D, G, A or X expected at character 3"},
  {"(I5/I5)", "a comma is missing at character 4"},
};
/* clang-format on */

static void check_wrong(const char *deck_text, const char *first,
                        const char *totals) {
  const char *number = strstr(first, "error P");
  PRINTED(closing,
          number == NULL ? "%s" : "%s; protis --explain %.5s says what to do",
          totals, number == NULL ? "" : number + strlen("error "));
  read_deck r = decks_read_text(deck_text);
  char *end = strchr(decks_messages(), '\n');
  ck_assert_msg(end != NULL, "no message for\n%s", deck_text);
  char *last = strrchr(decks_messages(), '\n');
  *last = '\0';
  ck_assert_str_eq(strrchr(decks_messages(), '\n') + 1, closing);
  *end = '\0';
  ck_assert_str_eq(decks_messages(), first);
  ck_assert_int_eq(r.st, OK);
  ck_assert_ptr_nonnull(r.d);
  decks_done(&r);
}

TEST(wrong_decks_are_answered_with_their_line) {
  decks_enter();
  for (size_t i = 0; i < sizeof wrong_decks / sizeof *wrong_decks; ++i)
    check_wrong(wrong_decks[i].text, wrong_decks[i].first,
                wrong_decks[i].totals);
  decks_leave();
}

TEST(wrong_formats_are_refused) {
  decks_enter();
  for (size_t i = 0; i < sizeof wrong_formats / sizeof *wrong_formats; ++i) {
    PRINTED(content, "*LEGACY, FORMAT=%s\n*A\n1\n", wrong_formats[i][0]);
    PRINTED(first, "a.inp:1:17: error P1027: %s in '%s'", wrong_formats[i][1],
            wrong_formats[i][0]);
    check_wrong(content, first, "1 error");
  }
  decks_leave();
}

TEST(all_errors_come_in_one_pass) {
  decks_enter();
  read_deck r = decks_read_text(
      "*A, B=\n<N>\n*PARAMETER\nx y\n*LEGACY, FORMAT=(Z)\n*C\n\"a\n");
  static const char *const numbers[] = {"P1007", "P1020", "P1019",
                                        "P1027", "P1011", "5 errors"};
  const char *p = decks_messages();
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
    p = strstr(p, numbers[i]);
    ck_assert_msg(p != NULL, "%s missing:\n%s", numbers[i], decks_messages());
  }
  decks_done(&r);
  decks_leave();
}

TEST(a_missing_deck_is_no_deck) {
  decks_enter();
  read_deck r = decks_read("none.inp", 0, NULL);
  ck_assert_int_eq(r.st, ERR_FILE);
  ck_assert_ptr_null(r.d);
  ck_assert_str_eq(decks_messages(),
                   "none.inp: error P1001: cannot read none.inp: No such file "
                   "or directory\n1 error; "
                   "protis --explain P1001 says what to do\n");
  decks_done(&r);
  r = decks_read(".", 0, NULL);
  ck_assert_int_eq(r.st, ERR_FILE);
  decks_done(&r);
  decks_leave();
}

TEST(a_nul_byte_ends_the_file) {
  static const char bytes[] = "*A\n1,\0 2\n*B\n";
  decks_enter();
  decks_write_bytes("a.inp", bytes, sizeof bytes - 1);
  read_deck r = decks_read("a.inp", 0, NULL);
  ck_assert_str_eq(decks_messages(),
                   "a.inp:2:3: error P1013: NUL byte: the file is not plain "
                   "text\n       2 | 1,\n         |   ^\n1 error; "
                   "protis --explain P1013 says what to do\n");
  ck_assert_str_eq(decks_shape(r.d), "*A");
  decks_done(&r);
  decks_leave();
}

TEST(a_line_has_at_most_4096_characters) {
  char content[10000];
  decks_enter();
  strcpy(content, "*A\n");
  memset(content + 3, '1', 4096);
  strcpy(content + 3 + 4096, "\r\n2\n");
  read_deck r = decks_read_good(content);
  ck_assert_int_eq(r.d->cards[0].n_record, 2);
  decks_done(&r);
  memset(content + 3, '1', 4097);
  strcpy(content + 3 + 4097, "\n2\n");
  r = decks_read_text(content);
  ck_assert_ptr_nonnull(
      strstr(decks_messages(),
             "a.inp:2:4097: error P1014: line of more than 4096 characters\n"));
  ck_assert_str_eq(decks_shape(r.d), "*A[2]");
  decks_done(&r);
  decks_leave();
}

TEST(too_many_parameters_are_refused) {
  char content[2000] = "*A";
  decks_enter();
  for (int i = 0; i < 65; ++i)
    snprintf(content + strlen(content), sizeof content - strlen(content),
             ", P%d", i);
  read_deck r = decks_read_text(content);
  ck_assert_ptr_nonnull(
      strstr(decks_messages(), "error P1033: more than 64 parameters"));
  ck_assert_int_eq(r.d->cards[0].n_parameter, 64);
  decks_done(&r);
  decks_leave();
}

/* ---- includes, definitions --------------------------------------------- */

TEST(includes_are_relative_and_may_hold_data_lines) {
  decks_enter();
  ck_assert_int_eq(mkdir("sub", 0777), 0);
  decks_write("sub/b.inp", "1,2\n*INCLUDE, INPUT=\"c d.inp\"\n5\n*B\n6\n");
  decks_write("sub/c d.inp", "3,\n4,\n");
  read_deck r = decks_read_good(
      "*PARAMETER\nN=1\n*A\n0\n*INCLUDE, INPUT=sub/b.inp\n7\n*C\n");
  ck_assert_str_eq(decks_shape(r.d), "*A[0][1|2][3|4][5]*B[6][7]*C");
  ck_assert_int_eq(r.d->n_file, 3);
  ck_assert_str_eq(r.d->files[0], "a.inp");
  ck_assert_str_eq(r.d->files[1], "sub/b.inp");
  ck_assert_str_eq(r.d->files[2], "sub/c d.inp");
  const field *f = &r.d->cards[0].records[2].fields[1];
  ck_assert_str_eq(f->at.file, "sub/c d.inp");
  ck_assert_int_eq(f->at.line_no, 2);
  ck_assert_str_eq(f->at.from->file, "sub/b.inp");
  ck_assert_int_eq(f->at.from->line_no, 2);
  ck_assert_str_eq(f->at.from->from->file, "a.inp");
  ck_assert_str_eq(deck_path(r.d, f), "sub/4");
  field absolute = *f;
  absolute.text = "/x/y";
  ck_assert_str_eq(deck_path(r.d, &absolute), "/x/y");
  ck_assert_str_eq(deck_path(r.d, &r.d->cards[0].records[0].fields[0]), "0");
  decks_done(&r);
  decks_leave();
}

TEST(a_circle_of_includes_is_found_with_its_chain) {
  decks_enter();
  ck_assert_int_eq(mkdir("sub", 0777), 0);
  decks_write("sub/b.inp", "*B\n*INCLUDE, INPUT=../sub/c.inp\n");
  decks_write("sub/c.inp", "*C\n*INCLUDE, INPUT=../a.inp\n");
  read_deck r = decks_read_text("*A\n*INCLUDE, INPUT=sub/b.inp\n*D\n");
  ck_assert_str_eq(
      decks_messages(),
      "sub/../sub/c.inp:2:17: error P1017: sub/../sub/../a.inp includes "
      "itself\n       2 | *INCLUDE, INPUT=../a.inp\n"
      "         |                 ^\n"
      "           included from sub/b.inp:2\n"
      "           included from a.inp:2\n1 error; "
      "protis --explain P1017 says what to do\n");
  ck_assert_str_eq(decks_shape(r.d), "*A*B*C*D");
  decks_done(&r);
  decks_leave();
}

TEST(includes_are_bounded_in_depth_and_number) {
  char name[40], content[200];
  decks_enter();
  for (int i = 0; i < 20; ++i) {
    snprintf(name, sizeof name, "d%d.inp", i);
    snprintf(content, sizeof content, "*A%d\n*INCLUDE, INPUT=d%d.inp\n", i,
             i + 1);
    decks_write(name, content);
  }
  read_deck r = decks_read("d0.inp", 0, NULL);
  ck_assert_ptr_nonnull(
      strstr(decks_messages(), "d16.inp:2:17: error P1018: includes "));
  ck_assert_int_eq(r.d->n_card, 17);
  ck_assert_int_eq(message_count(r.log, ERROR), 1);
  decks_done(&r);
  FILE *f = fopen("a.inp", "w");
  for (int i = 0; i < 1005; ++i) fputs("*INCLUDE, INPUT=b.inp\n", f);
  fclose(f);
  decks_write("b.inp", "*B\n");
  r = decks_read("a.inp", 0, NULL);
  ck_assert_ptr_nonnull(
      strstr(decks_messages(),
             "a.inp:1001:1: error P1018: more than 1000 includes\n"));
  ck_assert_int_eq(r.d->n_card, 1000);
  ck_assert_int_eq(message_count(r.log, ERROR), 1);
  decks_done(&r);
  decks_leave();
}

TEST(the_command_line_wins) {
  static const char *const defines[] = {"h=0.025", "Q = 2*h", "Big=1.5 +03"};
  double value;
  decks_enter();
  decks_write("a.inp", "*PARAMETER\nH=1\nN=<H>*2\n*A\n<H>,<N>,<Q>,<BIG>\n");
  read_deck r = decks_read("a.inp", 3, defines);
  ck_assert_str_eq(decks_messages(), "");
  ck_assert_str_eq(decks_shape(r.d), "*A[0.025|0.05|0.05|4.5]");
  ck_assert_int_eq(r.d->n_symbol, 4);
  ck_assert_str_eq(r.d->symbols[0].name, "H");
  ck_assert_int_eq(r.d->symbols[0].overridden, 1);
  ck_assert_int_eq(r.d->symbols[0].at.line_no, 2);
  ck_assert_ptr_null(r.d->symbols[1].at.file);
  ck_assert_int_eq(r.d->symbols[3].overridden, 0);
  ck_assert_int_eq(deck_symbol(r.d, "n", &value), 1);
  ck_assert(value == 0.05);
  ck_assert_int_eq(deck_symbol(r.d, "NN", &value), 0);
  decks_done(&r);
  decks_leave();
}

TEST(wrong_definitions_of_the_command_line_are_refused) {
  static const struct {
    const char *define, *first;
  } cases[] = {
      {"H", "command line: error P1026: -D H: NAME = VALUE expected"},
      {"", "command line: error P1026: -D : NAME = VALUE expected"},
      {"H=",
       "command line: error P1026: -D H=: no value after the equals sign"},
      {"2=3",
       "command line: error P1026: -D 2=3: a name is a letter followed by "
       "letters, digits and underscores"},
      {"A=5", "command line: error P1026: -D A=5: the name is defined already"},
      {"H=10.+5",
       "command line: error P1036: '10.+5' is a sum and a number with exponent;"
       " write E before the exponent, or a blank before the sign of a sum"},
      {"H=foo",
       "command line: error P1022: unknown name FOO in expression 'foo'"},
      {"H=<foo>", "command line: error P1020: unknown name <FOO>"},
      {"H=1/0", "command line: error P1023: '1/0' is not finite"},
  };
  decks_enter();
  decks_write("a.inp", "*A\n");
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    const char *const defines[] = {"A=1", cases[i].define};
    read_deck r = decks_read("a.inp", 2, defines);
    *strchr(decks_messages(), '\n') = '\0';
    ck_assert_str_eq(decks_messages(), cases[i].first);
    decks_done(&r);
  }
  decks_leave();
}

TEST(thousands_of_names_are_found) {
  size_t before = memory_in_use();
  decks_enter();
  FILE *f = fopen("a.inp", "w");
  fputs("*PARAMETER\n", f);
  for (int i = 0; i < 5000; ++i) fprintf(f, "N%d = %d\n", i, i);
  fputs("*A\n", f);
  for (int i = 0; i < 5000; ++i) fprintf(f, "<N%d>\n", i);
  fclose(f);
  read_deck r = decks_read("a.inp", 0, NULL);
  ck_assert_str_eq(decks_messages(), "");
  for (int i = 0; i < 5000; ++i) {
    int n = -1;
    ck_assert_int_eq(deck_int(&r.d->cards[0].records[i].fields[0], r.log, &n),
                     0);
    ck_assert_int_eq(n, i);
  }
  decks_done(&r);
  ck_assert_uint_eq(memory_in_use(), before);
  decks_leave();
}

/* ---- values ------------------------------------------------------------ */

TEST(values_are_numbers_or_expressions) {
  const double x[3] = {2, 3, 5};
  quantity q;
  double real;
  int whole;
  decks_enter();
  read_deck r =
      decks_read_good("*PARAMETER\nH=2\n*A\n1.5D1, \"x*H+t\", \"<H>*3\", 7\n");
  const field *f = r.d->cards[0].records[0].fields;
  ck_assert_int_eq(deck_quantity(r.d, &f[0], NULL, r.log, &q), 0);
  ck_assert(q.formula == NULL && q.number == 15 && q.factor == NULL);
  ck_assert_int_eq(deck_quantity(r.d, &f[1], NULL, r.log, &q), 0);
  ck_assert(q.formula != NULL && quantity_value(&q, x, 0.5) == 4.5);
  ck_assert_uint_eq(quantity_variables(&q), 9);
  ck_assert_int_eq(deck_quantity(r.d, &f[2], NULL, r.log, &q), 0);
  ck_assert(q.formula == NULL && q.number == 6);
  q.factor = &(value_table){.n = 2, .variable = 1};
  ck_assert_uint_eq(quantity_variables(&q), 2);
  ck_assert_int_eq(deck_real(&f[2], r.log, &real), 0);
  ck_assert(real == 6);
  ck_assert_int_eq(deck_int(&f[3], r.log, &whole), 0);
  ck_assert_int_eq(whole, 7);
  ck_assert_int_eq(message_count(r.log, ERROR), 0);
  decks_done(&r);
  decks_leave();
}

TEST(wrong_values_are_reported_at_their_place) {
  static const char *const wanted[] = {
      "a.inp:2:1: error P1024: not a number: 'x'\n",
      "a.inp:2:4: error P1024: not a number: '1.5q' (letters after the number)",
      "a.inp:2:10: error P1037: empty field, a number expected\n",
      "a.inp:2:11: error P1025: not an integer: '2.0'\n",
      "a.inp:2:20: error P1022: unknown name FOO in expression 'x+foo'\n",
      "a.inp:2:25: error P1023: '1/0' is not finite\n",
      "a.inp:2:32: error P1025: not an integer: '9999999999' (too large)\n",
      "a.inp:3:1: error P1024: not a number: 'x*2' (no expression of a "
      "constant "
      "value)\n"};
  quantity q;
  double real;
  int whole;
  decks_enter();
  read_deck r = decks_read_good(
      "*A\nx, 1.5q, ,2.0,\"  x+foo\",\"1/0\", 9999999999\n\"x*2\"\n");
  const field *f = r.d->cards[0].records[0].fields;
  ck_assert_int_eq(deck_real(&f[0], r.log, &real), -1);
  ck_assert_int_eq(deck_quantity(r.d, &f[1], NULL, r.log, &q), -1);
  ck_assert_int_eq(deck_real(&f[2], r.log, &real), -1);
  ck_assert_int_eq(deck_int(&f[3], r.log, &whole), -1);
  ck_assert_int_eq(deck_quantity(r.d, &f[4], NULL, r.log, &q), -1);
  ck_assert_int_eq(deck_quantity(r.d, &f[5], NULL, r.log, &q), -1);
  ck_assert_int_eq(deck_int(&f[6], r.log, &whole), -1);
  f = r.d->cards[0].records[1].fields;
  ck_assert_int_eq(deck_real(&f[0], r.log, &real), -1);
  decks_print(r.log);
  const char *p = decks_messages();
  for (size_t i = 0; i < sizeof wanted / sizeof *wanted; ++i) {
    p = strstr(p, wanted[i]);
    ck_assert_msg(p != NULL, "%s missing:\n%s", wanted[i], decks_messages());
  }
  decks_done(&r);
  decks_leave();
}

TEST(raw_lines_and_places_are_kept) {
  decks_enter();
  read_deck r =
      decks_read_good("*HEADING\n  A, title  \n*A, B=2\n 1, ** c\n  3\n");
  const card *heading = &r.d->cards[0], *a = &r.d->cards[1];
  ck_assert_str_eq(heading->records[0].raw, "  A, title  ");
  ck_assert_str_eq(a->records[0].raw, " 1, ** c");
  ck_assert_int_eq(a->at.line_no, 3);
  ck_assert_int_eq(a->at.column_no, 1);
  ck_assert_int_eq(a->parameters[0].at.column_no, 5);
  ck_assert_int_eq(a->parameters[0].value.at.column_no, 7);
  ck_assert_int_eq(a->records[0].fields[1].at.line_no, 5);
  ck_assert_int_eq(a->records[0].fields[1].at.column_no, 3);
  ck_assert_str_eq(a->records[0].fields[1].at.line, "  3");
  ck_assert_ptr_eq(card_parameter(a, "B"), &a->parameters[0]);
  ck_assert_ptr_null(card_parameter(a, "b"));
  decks_done(&r);
  decks_leave();
}

UNIT_MAIN("deck")
