#!/bin/sh
# SPDX-License-Identifier: MIT
# glint fmt, upgrade, schema and docs as a stranger uses them.
#   cli_format_test.sh PATH/TO/glint
# Ends with "N passed, N failed[, N skipped]".
set -u
. "$(dirname "$0")/cli.sh"
source=$root
shared=$source/../shared

# feed FILE STATUS ARGUMENT...: run, with a file as standard input.
feed() {
    input=$1
    expected=$2
    shift 2
    "$glint" "$@" >"$dir/out" 2>"$dir/err" <"$input"
    status=$?
    check "glint $*: status $status, not $expected" test $status -eq "$expected"
}
shows() { check "standard output shows: $1" grep -qF -e "$1" "$dir/out"; }
same() { check "$1 is $2" cmp -s "$1" "$2"; }

ugly() {
    printf '%s\n' '<Scene dialect="glint"><image> 64   48 </image> <!-- small -->' \
        '<camera/>  <surface type="Sphere">' '<RADIUS>.5</RADIUS></surface>' '' '' \
        '<light/></Scene>'
}
cat >tidy.xml <<'TEXT'
<scene dialect="glint">
  <image>64 48</image> <!-- small -->
  <camera/>
  <surface type="Sphere">
    <radius>.5</radius>
  </surface>

  <light/>
</scene>
TEXT

# ---------------------------------------------------------------- fmt

ugly >a.xml
chmod 640 a.xml
cp a.xml before.xml
run 1 fmt --check a.xml
printed a.xml
same a.xml before.xml
run 0 fmt --diff a.xml
shows '-<camera/>  <surface type="Sphere">'
shows '+  <surface type="Sphere">'
same a.xml before.xml
run 1 fmt --check --diff a.xml
if command -v patch >/dev/null 2>&1; then
    cp a.xml patched.xml
    check "the diff is a patch" patch -s patched.xml out
    same patched.xml tidy.xml
fi
ln -s a.xml link.xml
run 0 fmt link.xml
printed link.xml
silent fmt
same a.xml tidy.xml
check "a link stays a link" test -L link.xml
check "permissions stay" test "$(stat -c %a a.xml)" = 640
inode=$(stat -c %i a.xml)
run 0 fmt a.xml
printed ""
check "what is laid out is not written" test "$(stat -c %i a.xml)" = "$inode"
run 0 fmt --check a.xml
run 0 fmt --diff a.xml
printed ""

ugly >in
feed in 0 fmt -
same out tidy.xml
feed in 1 fmt --check -
printed stdin

# The folder, with one that is wrong: all others are laid out.
mkdir scenes
ugly >scenes/a.xml
ugly >scenes/c.xml
printf '<scene>\n  <camra/>\n  <image>4 2</image>\n</scene>\n' >scenes/b.xml
cp scenes/b.xml before.xml
run 1 fmt scenes
printed "scenes/a.xml
scenes/c.xml"
says 'scenes/b.xml:2:3: error: unknown element `camra` in the scene: did you mean `camera`?'
says 'scenes/b.xml: 1 error'
same scenes/b.xml before.xml
same scenes/c.xml tidy.xml
run 1 fmt missing.xml
says "cannot read 'missing.xml'"
run 2 fmt
run 2 fmt --chek a.xml
says "did you mean '--check'"
if [ "$(id -u)" -ne 0 ]; then
    mkdir locked
    ugly >locked/a.xml
    chmod 500 locked
    run 3 fmt locked/a.xml
    says "cannot write 'locked/a.xml'"
    chmod 700 locked
fi
printf '<?xml version="1.0" encoding="ISO-8859-1"?><scene><!--\351--><camera/>' >latin.xml
printf '<image>4 2</image>\r\n</scene>' >>latin.xml
run 0 fmt latin.xml
check "UTF-8 comes out" grep -qF 'encoding="UTF-8"' latin.xml
check "the letter too" grep -qF "$(printf '\303\251')" latin.xml
# A mesh that is not there is no matter of layout.
printf '<scene><camera/><image>4 2</image>%s</scene>' \
    '<surface type="Mesh"><data>no.obj</data></surface>' >mesh.xml
run 0 fmt mesh.xml

# ---------------------------------------------------------------- upgrade

cat >old.xml <<'TEXT'
<scene>
  <!-- a matte ball -->
  <image>64 48</image>
  <exposure>2</exposure>
  <camera type="PerspectiveCamera"><viewPoint>0 0 4</viewPoint></camera>
  <surface type="Sphere"/>
  <light><position>4 5 6</position><intensity>20 20 20</intensity></light>
</scene>
TEXT
run 0 upgrade old.xml
shows '<scene dialect="glint">'
shows '<intensity>20 20 20</intensity><falloff>inverse-square</falloff></light>'
shows '<!-- a matte ball -->'
says 'old.xml:1:1: different: shadow rays began at a distance of 0.001'
says 'from the rules of 2017; the picture may differ in 1 way (3 changes)'
cp out new.xml
run 0 upgrade --to glint -o new2.xml old.xml
printed ""
same new2.xml new.xml
run 0 upgrade --verbose new.xml
same out new.xml
says 'the picture is the same to the last bit (0 changes)'
run 1 upgrade --check --compare old.xml
says 'drawn with 64 x 48 pixels, all are the same to the last bit'
run 0 upgrade --dialect 2012 -v old.xml
says 'old.xml:1:1: same: the rules of 2012 become those of glint'
says 'the picture is the same to the last bit (1 change)'
run 0 upgrade --check new.xml
run 2 upgrade --to 2019 old.xml
says "--to takes glint"
run 2 upgrade old.xml new.xml
run 1 upgrade scenes/b.xml
printed ""
says 'unknown element'
run 3 upgrade -o missing/new.xml old.xml
says "cannot write 'missing/new.xml'"

# ---------------------------------------------------------------- docs

run 0 docs Cone
shows 'Cone: a surface type'
shows 'years: 2011, 2012, glint'
shows 'greater than 0, less than 180'
shows '<surface type="Cone">'
run 0 docs minpt
shows 'minPt: a point'
shows 'in: Box'
run 0 docs refractiveIndex Light light scene
shows 'in: Glazed, CookTorrance'
shows 'another word for PointLight'
shows 'type when none is given: Light'
run 0 docs
shows 'Types of surface'
silent docs
check "no colours in a file" test -z "$(tr -dc '\033' <out)"
run 2 docs Sfere
says "did you mean 'Sphere'"
run 2 docs difuseColor
says "did you mean 'diffuseColor'"
run 2 docs xyzzy
says 'glint docs lists them'
run 2 docs --format html
run 0 docs --format markdown Sphere
shows '| `radius` | number | 1 |'

# The page of the reference is that of this program, and its examples are scenes.
run 0 docs --format markdown
if cmp -s out "$source/docs/elements.md"; then pass; else
    fail "docs/elements.md is not what glint docs --format markdown prints"
fi
awk '/^```xml/ { n++; on = 1; next } /^```/ { on = 0 } on { print > ("example" n ".xml") }' out
count=0
for file in example*.xml; do
    if ! grep -q '<scene' "$file"; then
        image='<image>4 2</image>'
        camera='<camera/>'
        body=$(cat "$file")
        case $body in '<camera'*) camera= ;; esac
        printf '<scene>%s%s\n%s</scene>' "$image" "$camera" "$body" >whole.xml
        mv whole.xml "$file"
    fi
    "$glint" fmt "$file" >/dev/null 2>err || fail "an example of docs/elements.md is wrong: $file"
    count=$((count + 1))
done
check "examples are there" test $count -ge 35

# ---------------------------------------------------------------- schema

run 2 schema a.xml
run 2 schema --format dtd
run 0 schema
cp out glint.rng
run 0 schema --format xsd
cp out glint.xsd
silent schema
run 0 schema --dialect 2012
cp out 2012.rng
run 0 schema --format xsd --dialect 2018b
cp out 2018b.xsd

# valid WHAT OPTION SCHEMA FILE: by itself, or, if it is but its spelling, as fmt writes it.
valid() {
    "$glint" fmt - <"$3" >tidied.xml 2>/dev/null || return 1
    xmllint --noout --nonet "--$1" "$2" tidied.xml >out 2>err
}
if command -v xmllint >/dev/null 2>&1; then
    trees="$source/scenes $source/tests/golden $source/fuzz/corpus/reader"
    [ ! -d "$shared/reference" ] || trees="$trees $shared/reference"
    # shellcheck disable=SC2086 # a list
    find $trees -name '*.xml' | sort >list
    good=0
    while IFS= read -r file; do
        "$glint" fmt - <"$file" >/dev/null 2>&1 || continue
        if valid relaxng glint.rng "$file" && valid schema glint.xsd "$file"; then
            good=$((good + 1))
        else
            fail "$file is not valid by the schema"
        fi
    done <list
    check "scenes are valid" test "$good" -ge 38
    # What no schema can see: files, names, sizes, relations between values, depths.
    blind="cone-apex glazed-too-deep group-itself group-singular image-huge image-too-large
        no-image ref-unresolved ref-value-checked ref-wrong-kind refs-of-other-kinds too-large"
    # What XML Schema 1.0 cannot say besides, and what it takes from the parser.
    blinder="$blind attribute-list camera-parallel encoding-unknown missing-type no-camera
        shader-incomplete"
    for file in "$source"/tests/malformed/*.xml; do
        name=$(basename "$file" .xml)
        for schema in relaxng schema; do
            [ $schema = relaxng ] && known=$blind with=glint.rng || known=$blinder with=glint.xsd
            xmllint --noout --nonet --$schema $with "$file" >out 2>err
            invalid=$?
            # shellcheck disable=SC2086 # a list
            case " $(echo $known) " in
            *" $name "*) [ $invalid -eq 0 ] ;;
            *) [ $invalid -ne 0 ] ;;
            esac && pass || fail "tests/malformed/$name.xml and $schema: status $invalid"
        done
    done
    # A year's schema knows that year.
    check "2012 knows 2012" xmllint --noout --relaxng 2012.rng \
        "$source/tests/golden/groups-2012.xml" 2>err
    xmllint --noout --relaxng 2012.rng "$source/tests/golden/phong-2019.xml" >out 2>err
    check "2012 does not know 2019" test $? -ne 0
    check "2018b knows 2018b" xmllint --noout --schema 2018b.xsd \
        "$source/tests/golden/facets-2018b.xml" 2>err
else
    skipped=$((skipped + 1))
    echo "skip cli format: schemas (there is no xmllint)"
fi

# ---------------------------------------------------------------- all scenes of the project

run 0 fmt --check "$source/scenes"
printed ""

finish
