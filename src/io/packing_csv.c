/* CSV text to discs. Pure: no files, no memory of its own, so that it can be tested and fuzzed by itself.

   Lines end in LF or CR LF. Blank lines, and what follows '#' on a line, are passed over. A first line of names says
   which column is what; without it the columns are x,y,r or x,y,r,vx,vy. Lines that begin with "#!" are notes of the
   writer that are checked: "#! discs 1249", "#! periodic_x 0 0.25". A last line without its end is refused: a number
   that was cut short still looks like a number.

   strtod() reads the digits, in the C locale whatever the program has chosen. */
#include "packingimpl.h"
#include <fenv.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#if defined(__APPLE__)
  #include <xlocale.h>
#endif

enum { NUMBER = 64, SHOWN = 40 }; /* longest number; longest quotation in a message */

static const char *const value_name[PG_PACKING_VALUES] = {"x", "y", "r", "vx", "vy"};
static const char *const value_unit[PG_PACKING_VALUES] = {"m", "m", "m", "m/s", "m/s"};

/* A piece of a line. */
typedef struct {
  const char *at;
  size_t      length;
} Span;

const char *PgPackingValueName(int value) { return value_name[value]; }

static PetscBool IsBlank(char c) { return (PetscBool)(c == ' ' || c == '\t'); }

static Span Trim(const char *at, const char *end)
{
  while (at < end && IsBlank(*at)) at++;
  while (end > at && IsBlank(end[-1])) end--;
  return (Span){at, (size_t)(end - at)};
}

static PetscBool Equals(Span span, const char *word)
{
  if (span.length != strlen(word)) return PETSC_FALSE;
  for (size_t k = 0; k < span.length; k++) {
    const char c = span.at[k] >= 'A' && span.at[k] <= 'Z' ? (char)(span.at[k] - 'A' + 'a') : span.at[k];
    if (c != word[k]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The span as text for a message: printable, not too long. */
static const char *Quote(Span span, char text[SHOWN + 4])
{
  size_t n = 0;

  for (; n < span.length && n < SHOWN; n++) text[n] = span.at[n] >= ' ' && span.at[n] <= '~' ? span.at[n] : '?';
  (void)snprintf(text + n, 4, "%s", n < span.length ? "..." : "");
  return text;
}

static void Refuse(PgPackingCsv *csv, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
static void Refuse(PgPackingCsv *csv, const char format[], ...)
{
  va_list   arguments;
  const int head = snprintf(csv->reason, sizeof csv->reason, "line %lld: ", (long long)csv->line);

  va_start(arguments, format);
  (void)vsnprintf(csv->reason + head, sizeof csv->reason - (size_t)head, format, arguments);
  va_end(arguments);
}

static PetscBool IsNotFinite(Span span)
{
  if (span.length && (*span.at == '-' || *span.at == '+')) {
    span.at++;
    span.length--;
  }
  return (PetscBool)(Equals(span, "nan") || Equals(span, "inf") || Equals(span, "infinity"));
}

/* NULL or why the span is not a number that can be used. */
static const char *ReadNumber(Span span, PetscReal *value)
{
  char   text[NUMBER + 1], *end;
  double x;

  if (span.length == 0) return "is empty";
  if (IsNotFinite(span)) return "is not a finite number";
  if (span.length > NUMBER) return "is too long for a number";
  for (size_t k = 0; k < span.length; k++)
    if (!strchr("0123456789+-.eE", span.at[k]) || !span.at[k]) return "is not a number";
  (void)memcpy(text, span.at, span.length);
  text[span.length] = 0;
  x                 = strtod(text, &end);
  if (end == text || *end) return "is not a number";
  *value = (PetscReal)x;
  return isfinite(*value) ? NULL : "is not a finite number";
}

/* ---- what can be said about a disc, wherever it comes from ---- */

int PgPackingCheckDisc(const PetscReal disc[], char reason[], size_t size)
{
  const PetscReal far = 1e9, r = disc[PG_PACKING_R];

  for (int k = 0; k < PG_PACKING_VALUES; k++) {
    if (isfinite(disc[k])) continue;
    (void)snprintf(reason, size, "%s is not a finite number", value_name[k]);
    return k;
  }
  if (!(r > 0))
    (void)snprintf(reason, size, "r = %g m is not positive", (double)r);
  else if (r < 1e-12 || r > 1e6)
    (void)snprintf(reason, size, "r = %g m is not between 1e-12 and 1e6 m", (double)r);
  else
    reason[0] = 0;
  if (reason[0]) return PG_PACKING_R;
  for (int k = PG_PACKING_X; k <= PG_PACKING_Y; k++) {
    /* further out, overlaps would be made of rounding errors */
    if (PetscAbsReal(disc[k]) <= far * r) continue;
    (void)snprintf(reason, size, "%s = %g m is more than %g radii from the origin", value_name[k], (double)disc[k],
                   (double)far);
    return k;
  }
  for (int k = PG_PACKING_VX; k <= PG_PACKING_VY; k++) {
    if (PetscAbsReal(disc[k]) <= 1e6) continue;
    (void)snprintf(reason, size, "%s = %g m/s is faster than 1e6 m/s", value_name[k], (double)disc[k]);
    return k;
  }
  return -1;
}

const char *PgPackingCheckPeriod(PetscReal low, PetscReal high)
{
  if (!isfinite(low) || !isfinite(high)) return "the ends of the period in x are not finite numbers";
  if (PetscAbsReal(low) > 1e15 || PetscAbsReal(high) > 1e15) return "the ends of the period in x are beyond 1e15 m";
  return high > low ? NULL : "the upper end of the period in x does not lie above the lower end";
}

/* ---- lines ---- */

/* The next word of [*at, end). */
static Span Word(const char **at, const char *end)
{
  Span word;

  while (*at < end && IsBlank(**at)) (*at)++;
  word.at = *at;
  while (*at < end && !IsBlank(**at)) (*at)++;
  word.length = (size_t)(*at - word.at);
  return word;
}

static void TakeNote(PgPackingCsv *csv, const char *at, const char *end)
{
  const Span  name = Word(&at, end), first = Word(&at, end), second = Word(&at, end);
  char        shown[SHOWN + 4];
  PetscReal   a = 0, b = 0;
  const char *reason;

  if (csv->columns)
    Refuse(csv, "a note (#!) must stand above the table");
  else if (Equals(name, "discs") && !second.length) {
    reason = ReadNumber(first, &a);
    if (reason || csv->declared >= 0 || !(a >= 0 && a < 1e15 && a == floor(a)))
      Refuse(csv, "'#! discs %s' does not say a number of discs once", Quote(first, shown));
    else
      csv->declared = (PetscInt64)a;
  } else if (Equals(name, "periodic_x") && at == end) {
    reason = ReadNumber(first, &a);
    if (!reason) reason = ReadNumber(second, &b);
    if (reason)
      Refuse(csv, "an end of the period in x %s", reason);
    else if (csv->periodic)
      Refuse(csv, "a second period in x");
    else if ((reason = PgPackingCheckPeriod(a, b)))
      Refuse(csv, "%s", reason);
    csv->periodic = PETSC_TRUE;
    csv->low      = a;
    csv->high     = b;
  } else
    Refuse(csv, "unknown note '#! %s'; plain comments begin with '#' alone", Quote(name, shown));
}

/* Name and unit of a column, as in: x   "x"   x [m]   radius */
static int ColumnRole(PgPackingCsv *csv, Span field)
{
  char        shown[SHOWN + 4];
  const char *bracket;
  Span        name = field, unit = {NULL, 0};

  if (name.length >= 2 && name.at[0] == '"' && name.at[name.length - 1] == '"')
    name = Trim(name.at + 1, name.at + name.length - 1);
  bracket = name.length ? memchr(name.at, '[', name.length) : NULL;
  if (bracket && name.at[name.length - 1] == ']') {
    unit = Trim(bracket + 1, name.at + name.length - 1);
    name = Trim(name.at, bracket);
  }
  for (int k = 0; k < PG_PACKING_VALUES; k++) {
    if (!Equals(name, value_name[k]) && !(k == PG_PACKING_R && Equals(name, "radius"))) continue;
    if (unit.at && !Equals(unit, value_unit[k])) {
      Refuse(csv, "column %s is in '%s', it must be in %s", value_name[k], Quote(unit, shown), value_unit[k]);
      return -1;
    }
    return k;
  }
  for (size_t k = 0; k < name.length; k++)
    if (name.at[k] && strchr("; \t", name.at[k])) {
      Refuse(csv, "unknown column '%s'; names and values are separated by commas, as in x,y,r", Quote(field, shown));
      return -1;
    }
  Refuse(csv, "unknown column '%s'; the names are x, y, r and, if velocities are given, vx, vy", Quote(field, shown));
  return -1;
}

/* Fields of a line, separated by commas; more than fit are counted only. */
static int Split(const char *at, const char *end, Span field[PG_PACKING_VALUES])
{
  int n = 0;

  for (;; n++) {
    const char *comma = memchr(at, ',', (size_t)(end - at));
    if (n < PG_PACKING_VALUES) field[n] = Trim(at, comma ? comma : end);
    if (!comma) return n + 1;
    at = comma + 1;
  }
}

static void TakeHeader(PgPackingCsv *csv, int n, const Span field[])
{
  int column[PG_PACKING_VALUES] = {0}; /* 1 + where the value stands */

  if (n > PG_PACKING_VALUES) {
    Refuse(csv, "%d columns; at most x,y,r,vx,vy are known", n);
    return;
  }
  for (int k = 0; k < n; k++) {
    const int role = ColumnRole(csv, field[k]);
    if (role < 0) return;
    if (column[role]) {
      Refuse(csv, "columns %d and %d have the same name %s", column[role], k + 1, value_name[role]);
      return;
    }
    column[role] = k + 1;
    csv->role[k] = role;
  }
  for (int k = 0; k <= PG_PACKING_R; k++) {
    if (column[k]) continue;
    Refuse(csv, "there is no column %s", value_name[k]);
    return;
  }
  if (!column[PG_PACKING_VX] != !column[PG_PACKING_VY]) Refuse(csv, "of vx and vy there must be both or none");
  csv->columns = n;
}

static void TakeDisc(PgPackingCsv *csv, int n, const Span field[], PetscReal disc[])
{
  char shown[SHOWN + 4], reason[96];

  if (!csv->columns) { /* no line of names */
    if (n != 3 && n != 5) {
      Refuse(csv, "%d values separated by commas; without a line of names there must be 3 (x,y,r) or 5 (x,y,r,vx,vy)",
             n);
      return;
    }
    csv->columns = n;
    for (int k = 0; k < n; k++) csv->role[k] = k;
  }
  if (n != csv->columns) {
    Refuse(csv, "%d values separated by commas, the table has %d columns", n, csv->columns);
    return;
  }
  for (int k = 0; k < PG_PACKING_VALUES; k++) disc[k] = 0;
  for (int k = 0; k < n; k++) {
    const char *why = ReadNumber(field[k], &disc[csv->role[k]]);
    if (!why) continue;
    Refuse(csv, "%s = '%s' %s", value_name[csv->role[k]], Quote(field[k], shown), why);
    return;
  }
  if (PgPackingCheckDisc(disc, reason, sizeof reason) >= 0)
    Refuse(csv, "%s", reason);
  else if (csv->discs >= PG_PACKING_MOST)
    Refuse(csv, "more discs than the integers of this PETSc can count");
  else
    csv->discs++;
}

/* Whether the first line of the table holds names: a word that is not nan or inf. */
static PetscBool IsHeader(Span first)
{
  const char c = first.length ? *first.at : 0;
  return (PetscBool)((c == '"' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) && !IsNotFinite(first));
}

/* A line without its end; true when it held a disc. */
static PetscBool TakeLine(PgPackingCsv *csv, const char *at, const char *end, PetscReal disc[])
{
  Span        field[PG_PACKING_VALUES], whole;
  const char *hash;
  int         n;

  if (csv->line == 1 && end - at >= 3 && !memcmp(at, "\xef\xbb\xbf", 3)) at += 3; /* the mark of UTF-8 */
  if (at < end && end[-1] == '\r') end--;
  if (memchr(at, 0, (size_t)(end - at)))
    Refuse(csv, "a zero byte: this is not a text file");
  else if (memchr(at, '\r', (size_t)(end - at)))
    Refuse(csv, "a carriage return inside: lines must end in LF or CR LF");
  if (csv->reason[0]) return PETSC_FALSE;
  whole = Trim(at, end);
  if (whole.length >= 2 && whole.at[0] == '#' && whole.at[1] == '!') {
    TakeNote(csv, whole.at + 2, whole.at + whole.length);
    return PETSC_FALSE;
  }
  hash = whole.length ? memchr(whole.at, '#', whole.length) : NULL;
  if (hash) whole = Trim(whole.at, hash);
  if (!whole.length) return PETSC_FALSE;
  n = Split(whole.at, whole.at + whole.length, field);
  if (!csv->columns && IsHeader(field[0])) {
    TakeHeader(csv, n, field);
    return PETSC_FALSE;
  }
  TakeDisc(csv, n, field, disc);
  return (PetscBool)!csv->reason[0];
}

void PgPackingCsvStart(PgPackingCsv *csv)
{
  (void)memset(csv, 0, sizeof *csv);
  csv->declared = -1;
}

/* After the last line. */
static void CheckEnd(PgPackingCsv *csv)
{
  if (csv->declared >= 0 && csv->discs != csv->declared)
    (void)snprintf(csv->reason, sizeof csv->reason,
                   "%lld discs, but the note '#! discs %lld' above the table: the file has been cut or edited; correct "
                   "or remove the note",
                   (long long)csv->discs, (long long)csv->declared);
  else if (!csv->discs)
    (void)snprintf(csv->reason, sizeof csv->reason, "it holds no disc");
}

static size_t TakeLines(PgPackingCsv *csv, const char text[], size_t size, PetscBool last, PetscInt room,
                        PetscReal disc[], PetscInt *discs)
{
  size_t used = 0;

  while (*discs < room && used < size && !csv->reason[0]) {
    const char  *end    = memchr(text + used, '\n', size - used);
    const size_t length = end ? (size_t)(end - (text + used)) : size - used;

    if (!end && !last && length <= PG_PACKING_LINE) break;
    csv->line++;
    if (length > PG_PACKING_LINE)
      Refuse(csv, "longer than %d bytes: this is not a table of discs", PG_PACKING_LINE);
    else if (!end)
      Refuse(csv, "the last line has no end: the file may have been cut; if it is complete, end it with a line feed");
    else if (TakeLine(csv, text + used, end, disc + PG_PACKING_VALUES * *discs))
      (*discs)++;
    if (!csv->reason[0]) used += length + 1;
  }
  if (last && used == size && !csv->reason[0]) CheckEnd(csv);
  return used;
}

size_t PgPackingCsvParse(PgPackingCsv *csv, const char text[], size_t size, PetscBool last, PetscInt room,
                         PetscReal disc[], PetscInt *discs)
{
  const locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
  locale_t       before;
  fenv_t         traps;
  size_t         used;

  *discs = 0;
  if (csv->reason[0]) return 0;
  if (!plain) {
    (void)snprintf(csv->reason, sizeof csv->reason, "the system has no C locale to read numbers in");
    return 0;
  }
  before = uselocale(plain);
  (void)feholdexcept(&traps); /* 1e999 overflows inside strtod(): our message, not a trap */
  used = TakeLines(csv, text, size, last, room, disc, discs);
  (void)fesetenv(&traps);
  (void)uselocale(before);
  freelocale(plain);
  return used;
}
