#!/bin/sh
# SPDX-License-Identifier: MIT
# check_docs.sh ROOT: docs and code agree.
#   - Every concept in include/, but for namespaces and folders called detail, is in a row of
#     docs/extending.md.
#   - The code in docs/extending.md is what tests compile between two lines `// [extending]`, and nothing else
#     is.
#   - Files and folders that docs/*.md and README.md name in backticks exist.
#   - What docs/notation.md says is in a file is there.
# Prints file:line: what is wrong, and fails if there was anything.
set -eu
cd "$1"
report=$(mktemp)
trap 'rm -f "$report"' EXIT
{
  find include -name '*.hpp' ! -path '*/detail/*' | sort | xargs awk '
    BEGIN {
      while ((getline line < "docs/extending.md") > 0) {
        if (line !~ /^\|/) continue
        n = split(line, part, "`")
        for (i = 2; i <= n; i += 2) row[part[i]] = 1
      }
    }
    FNR == 1 { hidden = 0 }
    /^namespace (palpate::)?detail [{]/ { hidden = 1 }
    /^[}]  \/\/ namespace (palpate::)?detail/ { hidden = 0 }
    !hidden && /^concept / && !($2 in row) {
      print FILENAME ":" FNR ": concept " $2 " has no row in docs/extending.md"
    }
  '

  grep -rl '^// \[extending\]$' tests | sort | xargs awk '
    FILENAME ~ /[.]md$/ {
      if ($0 == "```cpp") { on = FNR; block = "" }
      else if ($0 == "```" && on) { shown[block] = on; on = 0 }
      else if (on) block = block $0 "\n"
      next
    }
    FNR == 1 { on = 0 }
    $0 == "// [extending]" {
      on = on ? 0 : FNR
      if (on) block = ""
      else made[block] = FILENAME ":" FNR
      next
    }
    on { block = block $0 "\n" }
    END {
      for (b in shown) if (!(b in made)) print "docs/extending.md:" shown[b] ": no test has this code between two lines // [extending]"
      for (b in made) if (!(b in shown)) print made[b] ": the code above is not in docs/extending.md"
    }
  ' docs/extending.md

  # FILE:LINE NAME, a line for each name in backticks that looks like a file or a folder of the tree.
  awk '
    {
      n = split($0, part, "`")
      for (i = 2; i <= n; i += 2)
        if (part[i] ~ /^[.A-Za-z0-9_\/-]*[.](hpp|cpp|sh|cmake|py|md)$/ || part[i] ~ /^[a-z0-9_]+(\/[a-z0-9_]+)*\/$/)
          print FILENAME ":" FNR, part[i]
    }
  ' docs/*.md README.md | while read -r where name; do
    case $name in
      out/* | build/*) continue ;;  # made by a run
      */*)
        for below in . include include/palpate tests bench docs; do
          if [ -e "$below/$name" ]; then continue 2; fi
        done
        ;;
      *) if [ -n "$(find include tests bench examples docs tools ./*.md -name "$name" 2>/dev/null | head -n 1)" ]; then continue; fi ;;
    esac
    echo "$where: there is no $name"
  done

  # Columns `code` and `file`: each identifier of the first is in one of the files of the second.
  awk -F ' *[|] *' '
    !/^\|/ { code = 0; next }
    { for (i = 2; i < NF; i++) if ($i == "code") code = i; else if ($i == "file") file = i }
    !code || $code == "code" || $code ~ /^-+$/ { next }
    {
      text = ""
      n = split($file, part, "`")
      for (i = 2; i <= n; i += 2) {
        path = "include/palpate/" part[i]
        while ((getline line < path) > 0) text = text line "\n"
        close(path)
      }
      m = split($code, part, "`")
      for (i = 2; i <= m; i += 2) {
        k = split(part[i], name, /[^A-Za-z0-9_]+/)
        for (j = 1; j <= k; j++)
          if (name[j] != "" && text !~ "(^|[^A-Za-z0-9_])" name[j] "([^A-Za-z0-9_]|$)")
            print FILENAME ":" FNR ": " name[j] " is in none of this row'"'"'s files"
      }
    }
  ' docs/notation.md
} >"$report"

cat "$report"
[ ! -s "$report" ]
