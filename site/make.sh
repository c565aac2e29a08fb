#!/usr/bin/env bash
# make.sh: the documentation as a site in build/site/html, with pages of the library's headers below api/. Fails on a warning: a link
# that leads nowhere, a comment that doxygen does not understand. Run from the repository's root by ./dev site.
set -euo pipefail

work=build/site
rm -rf $work
mkdir -p $work/docs $work/api

# The headers that are installed.
cmake -DSOURCE="$PWD" -DDESTINATION="$PWD/$work/include" -P cmake/public_headers.cmake >/dev/null
doxygen site/Doxyfile 2>$work/doxygen.log || { cat $work/doxygen.log >&2; exit 1; }

# The pages, with the README as the first; what links to a file of the repository that is no page leads to that file's name alone.
cp -r docs/. $work/docs
# Their list has the name README.md where it is read in the repository.
mv $work/docs/README.md $work/docs/pages.md
sed -E 's#\(docs/#(#g; s#\(README\.md#(pages.md#g' README.md >$work/docs/index.md
sed -i -E 's#\(\.\./README\.md#(index.md#g' $work/docs/*.md
for page in $work/docs/*.md; do
  sed -i -E 's#\[([^]]*)\]\((\.\./[^)]*|adapters|data/[^)]*|examples/[^)]*|bindings/[^)]*|[A-Z]+(\.md)?)\)#\1#g' "$page"
done
# In the pages of algorithms, which lie one folder deeper, links to other pages and pictures begin with ../, those to sources with ../../.
sed -i -E -e 's#\(\.\./\.\./README\.md#(../index.md#g' -e 's#\(\.\./README\.md#(../pages.md#g' \
  -e 's#\[([^]]*)\]\(\.\./\.\./[^)]*\)#\1#g' $work/docs/algorithms/*.md
mkdocs build --quiet -f site/mkdocs.yml
cp -r $work/api $work/html/api
echo "The site is in $work/html"
