//! Every form of reference 1.9 and 10.9 and of the survey of real files, by name: what parses, and what must not.

use super::messages;

/// Reference 10.9, line by line, and "what a grammar must accept" of the survey, by its numbers.
const ACCEPTED: &[(&str, &str)] = &[
    ("version first", "version \"2025.1\"\nA --> NIL"),
    ("numbers: dot first, dot last, exponent", "f1 = .5 + 1. + 2e-1"),
    ("numbers: every form", "f = 3 + 3.25 + .75 + 3. + 1e-10 + 2.5E3 + 001 + 3.e2"),
    ("a name that begins like a keyword", "constant_like = 3        # not the keyword const"),
    ("a dotted attribute name", "attr a.b = 1             // dotted attribute name"),
    ("a percentage as attribute", "attr kind = 50% : \"x\" else : \"y\""),
    ("locals of a function", "half(x) with( h := x/2 ) = h"),
    ("chains in chains", "Lot -->\n case kind == \"x\" :\n case scope.sx > 10 : A(1).\n else : B.\n else : NIL"),
    ("relative sizes", "Lot --> s('0.9 , '1, ' 0.9) center(xz) [ t(0, '1 + 2, 0) Marker ] extrude(half(9)) Mass"),
    (
        "selectors of every kind",
        "M --> comp(f) { geometry.area > 20 && !top : [ case comp.index % 2 == 0 : Even else : Odd ]\n| top = \
         roofGable(case scope.sx > 8 : 25 else : 40) Roof.\n| all : NIL }",
    ),
    ("repeat in a split", "Even --> split(y) { { ~3 : F | 0.2 : G. }* | ~1 : H }"),
    ("a percentage in a rule", "F --> 60% : W. else : report(\"n.\" + split.index, 1) W."),
    ("a dotted rule name", "G.H --> NIL"),
    ("1: mark, CRLF and no last line end", "\u{feff}attr h = 3\r\nLot-->extrude(h)Mass"),
    ("1: letters beyond ASCII", "attr höhe = 3 // Straße\nA --> NIL"),
    ("2: comments anywhere", "A(/*a*/b// c\n, d #e\n) --> split(x) { 1 /*:*/ : // B\n B # C\n | 2 : C }"),
    ("2: no comment in a string", "f = \"#ff8800 // /* no */\""),
    ("3: words as names", "f(x, u, top, size, shape, left, floor, p) = x + u + top + size + shape + left + floor + p"),
    ("3: a rule like an operation", "t --> t(1, 0, 0) t\nstart --> NIL"),
    ("3: start as a name", "A --> start start(1)\nattr start = 2\nf = start + extends"),
    ("3: words of operations as names", "attr split = 1\nattr comp = split\nf(union) = union + inline + scatter"),
    ("4: no version", "attr a = 1"),
    ("5: import", "import win : \"rules/my window.cga\""),
    ("5: import with a list", "import a : \"/p/q.cga\" ( h = 3, // note\n keep, c.d = h * 2,\n Cap --> Own )"),
    ("5: import with nothing shared", "import a : \"f.cga\" ()"),
    ("5: import of styles", "import a (Old, New-er) : \"f.cga\""),
    ("5: an extension with parameters", "import m : \"m.cga\"( Cap(h) --> extrude(h) Side, w = 2 )"),
    ("6: annotations on one line", "@Group(\"A\", 1) @Range(0, -10) @Order(1) attr a = 1"),
    (
        "6: annotations anywhere",
        "@Hidden import a : \"f.cga\" @Order() const b = 1 @Hidden f = 2 @StartRule Lot --> NIL @Group",
    ),
    ("6: named ranges", "@Range(min=0, max=b * 2, stepsize = 0.1, restricted=false) attr a = 1"),
    ("6: lists of values", "@Range(\"a\", \"b\") attr a = \"a\"\n@Range(1, 2, 3) attr b = 1\n@Range attr c = 1"),
    (
        "6: values of an attribute",
        "@Enum(valuesAttr=list, restricted=false) attr a = 1\n@Hidden(a, b) import c : \"f.cga\"",
    ),
    ("6: handles", "@Handle(shape=Box*^2, axis=y, skin=doubleArrow, translate={0,1,0}, reference=edge) attr a = 1"),
    ("6: misspelt annotations", "@Decription(\"x\") @range(1) @Startrule A --> NIL"),
    ("6: other legacy keys", "@Range(Low=0.5, High=2) attr a = 1\n@Group(Size, 2) attr b = 1"),
    ("7: forward references, functions between rules", "A --> B(f)\nf = case g : 1 else : 2\nB(x) --> NIL\ng() = true"),
    ("8: styles", "style Night\nattr a = 2\nstyle Dark-Night extends Night\nattr a = 3"),
    ("9: rules of an import are replaced", "win.Frame --> extrude(0.1)\nA(x,y)-->win.start(3)"),
    ("9: modifiers", "start Lot --> Cap\nextension Cap(h) --> NIL"),
    ("10: else takes a chain", "A --> case a : B else : case b : C else : D"),
    ("10: chains in percentages and back", "A --> 50% : case a : B else : C 20% : 10% : D else : E else : F"),
    ("11: space around the percent sign", "A --> 05% : B 5 % : C 7%:D else : E"),
    ("11: remainder and percentage on a line", "A --> 7 % 4 % : B else : C(9 % 2)"),
    ("11: a computed percentage", "A --> share * 2 % : B f(x) % : C else : D"),
    (
        "11: percentages as arguments",
        "A --> color(50% : \"#fff\" else : \"#000\") B((20% : 1 else : 2)) set(a, 10% : 1 else : 2)",
    ),
    ("12: operations behind a block", "A --> comp(f) { top : B } extrude(2) [ case a : C else : D ] lib.E(1) F"),
    ("13: operations without parentheses", "A --> primitiveCube reverseNormals innerRect NIL\nB --> trim"),
    ("14: terminals", "A --> comp(f) { top : B.| side : C. // wall\n| all : D.} E.\nF --> G.\nH --> I.(2) J(1)."),
    ("15: a block on the next line, space in front of the star", "A --> split(x)\n{ 1 : B | { ~2 : C } * } *"),
    (
        "15: selectors with =",
        "A --> setback(2) { street.front = B | remainder : C } shapeL(1, 2) { shape = D } comp(f) { 0 =: E }",
    ),
    (
        "15: items without a size",
        "A --> split(x) { B } split(y) { C | 1 : D } scatter(surface, 9, uniform) { E } inline { F }",
    ),
    ("15: a bar too many", "A --> split(x) { 1 : B | }"),
    ("16: sizes", "A --> split(x) { ~ h : B | '(0.5) : C | ' 1 : D | ~-1 : E | ~f(1) : G | 'w : H | 2 * w : I }"),
    (
        "16: prefixes in arguments",
        "A --> s('1, '-.5, \u{2019}w) setupProjection(0, scope.xy, ~3, '1, ' 2) tileUV(0, ~1, '(2))",
    ),
    (
        "18: strings",
        "f = \"\\\"q\\\"\" + \"a;b\" + \"*.jpg\" + \"$x\" + \"it's\" + \"\" + \"two\nlines\" + \"\\u0041\\n\\t\\\\\"",
    ),
    ("19: operators", "f = -a + +b - !c * d / e % g < h <= i > j >= k == l != m && n || o"),
    ("20: arrays", "f = [1, 2; 3, 4][1, 0] + a[0] + a[1:3] + a[a .== 2] + [5:-1:0][0]"),
    (
        "20: element-wise operators",
        "f = a .+ b .- c .* d ./ e .% g .< h .<= i .> j .>= k .== l .!= m .&& n .|| .!o + .-p + .+q",
    ),
    ("20: a number before an element-wise operator", "f = 3.*v + 2.+[1, 2] + 1./.5"),
    ("20: comp as a function", "f = comp(fe) { top && isTagged(\"a\") : comp.index | all = case x : 1 else : 2 }"),
    ("21: empty parentheses", "f() = rand() A() --> B() f()"),
    ("1.9: a chain as an argument", "A --> roofHip(case wide : 25 else : 40)"),
    ("1.9: no body", "A -->\nB --> case x : else : NIL"),
    (
        "1.9: boolean operations, old and new",
        "A --> union { B. | C } subtract B intersect(swap) C subtract { [ D ] | E(1) F }",
    ),
    (
        "1.9: inline",
        "A --> inline(append) B(1) inline { C. } inline comp(f) { all : D. } inline [ E ] inline(unify) { F }",
    ),
    (
        "1.9: modify and setbacks",
        "A --> modify(v) { 0 : t(0,0,1) } setbackPerEdge(1) { all : B } innerRectangle(edge) { shape : C }",
    ),
    ("1.9: perimeters", "A --> splitAndSetbackPerimeter('0.1) { 10 : 1 : B | { ~1 : 0 : NIL }* } { remainder : R }"),
    ("1.9: dynamic imports", "A --> lib(h = 3, Cap(x) --> extrude(x) B, keep).Rule(2) lib( ).Other lib(a = 1).start C"),
    (
        "1.9: locals",
        "R(p) with( a := p * 2  b := a, c := case b > 1 : 1 else : 2 ) --> S(a, b, c)\nattr d with(e := 1) = e",
    ),
    ("2.6: the map attribute", "attr streetWidth(edge) = 0"),
    (
        "9: legacy forms",
        "A --> setPivot(yUp, 2) extrude(world.y, 3) i(\"builtin:cube\") setback(1) { streetSide : B | noStreetSide : C }",
    ),
    ("an empty file", ""),
    ("only a comment", "// nothing"),
];

/// A text that must be refused, and how its first message begins.
const REFUSED: &[(&str, &str, &str)] = &[
    ("case and percentage on a level", "A --> case x : B 30% : C else : D", "1: expected"),
    ("a chain behind an operation", "A --> t(1, 0, 0) case x : B else : C", "1: expected"),
    ("a chain without else", "A --> case x : B\nC --> NIL", "2: expected"),
    ("a closing parenthesis is missing", "A --> extrude(3\nB --> NIL", "2: expected `,` or `)`, found `B`"),
    ("branches without a colon", "A --> case x B else C", "1: expected"),
    ("an import without prefix and quotes", "import rules/window.cga\nA --> NIL", "1: expected `:`, found `/`"),
    ("a space in the arrow", "A -- > B", "1: expected"),
    ("an empty argument", "A --> t(1, , 2)", "1: expected an expression, found `,`"),
    ("an empty array", "f = []", "1: expected an expression, found `]`"),
    ("declarations in a body", "A --> B { attr x = 2 }", "1: expected"),
    ("a dollar sign", "attr a$b = 1", "1: expected"),
    ("single quotes", "A --> texture('a.jpg')", "1: expected"),
    ("a prefix inside an expression", "A --> s(1 + '2, 1, 1)", "1: expected"),
    ("a string that is never closed", "A --> color(\"#fff)", "1: this string is not closed on its line"),
    ("two dots", "f = a..b", "1: expected"),
    ("a unit", "attr a = 2m", "1: expected an expression, found `2m`"),
    ("a reserved word as a name", "attr case = 1", "1: expected a name, found `case`"),
    ("semicolons", "A --> B;", "1: expected"),
    ("a block without its operation", "A --> { 1 : B }", "1: expected"),
    ("a split without a block's end", "A --> split(x) { 1 : B\nC --> NIL", "2: expected `|` or `}`, found `C`"),
];

#[test]
fn every_form_is_accepted() {
    for (name, text) in ACCEPTED {
        let found = messages(text);
        assert!(found.is_empty(), "{name}\n{text}\n{found:#?}");
    }
}

#[test]
fn what_is_no_form_is_refused() {
    for (name, text, first) in REFUSED {
        let found = messages(text);
        assert!(found.first().is_some_and(|message| message.starts_with(first)), "{name}\n{text}\n{found:#?}");
    }
}
