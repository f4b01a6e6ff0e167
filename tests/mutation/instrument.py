#!/usr/bin/python3
"""Writes a copy of the portable sources in which every mutation is a choice at run time.

usage: instrument.py ROOT OUT

ROOT is the checkout. OUT receives OUT/tree/... (the mutated sources, to come before ROOT in the include path) and
OUT/mutants.json (what each id changes). Mutations are insertions only: `a < b` becomes
`(mutant(7)?(a <= b):mutant(8)?(a >= b):(a < b))`, so that they nest and lines stay where they are.
"""
import json
import os
import re
import sys
from pathlib import Path

import clang.cindex as clang

FOLDERS = ("protocol/wire", "firmware_sim/core")
K = clang.CursorKind
T = clang.TypeKind

COMPARISONS = {"<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",)}
ARITHMETIC = {"+": ("-",), "-": ("+",), "*": ("/", "+"), "/": ("*",), "%": ("/",)}
BITWISE = {"&": ("|",), "|": ("&",), "^": ("|",), "<<": (">>",), ">>": ("<<",)}
ASSIGNMENTS = {"+=": ("-=",), "-=": ("+=",), "*=": ("/=",), "/=": ("*=",), "|=": ("&=",), "&=": ("|=",), "^=": ("|=",)}
INTEGERS = {T.CHAR_U, T.UCHAR, T.USHORT, T.UINT, T.ULONG, T.ULONGLONG, T.SCHAR, T.SHORT, T.INT, T.LONG, T.LONGLONG}
FUNCTIONS = {K.FUNCTION_DECL, K.CXX_METHOD, K.CONSTRUCTOR, K.FUNCTION_TEMPLATE, K.CONVERSION_FUNCTION}
UNEVALUATED = {K.STATIC_ASSERT, K.TYPE_ALIAS_DECL, K.TYPE_ALIAS_TEMPLATE_DECL, K.TYPEDEF_DECL, K.ENUM_DECL,
               K.TEMPLATE_TYPE_PARAMETER, K.TEMPLATE_NON_TYPE_PARAMETER, K.CXX_UNARY_EXPR}
TABLE = 1 << 13  # mutant.hpp, kTable
MUTANT = " ::pinjaw::mutation::mutant(%d)"


class File:
    """One source: its text, its mutants, and what is to be inserted."""

    def __init__(self, root, name, book):
        self.name, self.book = name, book
        self.text = (root / name).read_bytes()
        self.inserts = []  # (position, order, text)
        self.done = set()
        self.wraps = 0

    def slice(self, node):
        return self.text[node.extent.start.offset:node.extent.end.offset].decode()

    def line_of(self, position):
        return self.text.count(b"\n", 0, position) + 1

    def note(self, start, end, replacement, family, function):
        """Books a mutant that puts `replacement` at [start, end); gives its id."""
        first = self.text.rfind(b"\n", 0, start) + 1
        last = self.text.find(b"\n", end)
        flat = lambda raw: " ".join(raw.split())
        before, after = self.text[first:start].decode(), self.text[end:last].decode()
        self.book.append({
            "id": len(self.book), "file": self.name, "line": self.line_of(start), "function": function, "family": family,
            "original": flat(before + self.text[start:end].decode() + after), "mutated": flat(before + replacement + after)})
        return len(self.book) - 1

    def wrap(self, start, end, choices, keep="(%s)"):
        """`choices`: (id, text) that take the place of [start, end)."""
        self.wraps += 1
        head = "".join(f"{MUTANT % i}?({text}) : " for i, text in choices)
        opening, closing = keep.split("%s")
        self.inserts.append((start, 0, -end, self.wraps, "(" + head + opening))
        self.inserts.append((end, -1, -start, -self.wraps, closing + ")"))

    def mutate(self, node, replacements, family, function, keep="(%s)"):
        """`replacements`: texts for the whole node."""
        self.mutate_range(node.extent.start.offset, node.extent.end.offset, replacements, family, function, keep)

    def mutate_range(self, start, end, replacements, family, function, keep="(%s)"):
        key = (start, end, family)
        if key in self.done:
            return
        self.done.add(key)
        self.wrap(start, end, [(self.note(start, end, r, family, function), r) for r in replacements], keep=keep)

    def delete(self, start, end, function):
        """Makes the statement [start, end), its semicolon included, a choice."""
        if (start, end, "delete") in self.done:
            return
        self.done.add((start, end, "delete"))
        mutant = self.note(start, end, ";", "delete statement", function)
        self.wraps += 1
        self.inserts.append((start, 0, -end, self.wraps, "{if(!%s){" % (MUTANT % mutant)))
        self.inserts.append((end, -1, -start, -self.wraps, "}}"))

    def table(self):
        """The state table: every place to every other value, in the copy that `reaction` looks at."""
        text = self.text.decode()
        look = "return look_up(table, state, event);"
        rows = re.findall(r"/\* (\w+) +\*/ \{([\w, ]+)\}", text)
        states, values = len(rows[0][1].split(",")), "Bt Rc Un Ld Rd Sg Sd Sq Tk Hd Of Rx Rs Op Fh Fe Re Ig St".split()
        if text.count(look) != 1 or any(len(cells.split(",")) != states for _, cells in rows):
            sys.exit("instrument.py: " + self.name + ": the state table is not where it was")
        at = text.index(look)
        self.inserts.append((at, 0, 0, 0, f"""StateTable copy = table;
auto& at = copy[static_cast<std::size_t>(event)][static_cast<std::size_t>(state)];
if (&table == &kStateTable) at = static_cast<Cell>(::pinjaw::mutation::cell(static_cast<int>(event) * {states} + static_cast<int>(state), static_cast<unsigned char>(at)));
return look_up(copy, state, event);
"""))
        for row, (event, cells) in enumerate(rows):
            for column, now in enumerate(cell.strip() for cell in cells.split(",")):
                for value, other in enumerate(values):
                    if other == now:
                        continue
                    place = row * states + column
                    self.book.append({
                        "id": TABLE + place * 32 + value, "reach": TABLE + place, "file": self.name, "line": self.line_of(self.text.index(event.encode())),
                        "function": "kStateTable", "family": "table", "original": f"{event} in {values[column]}: {now}",
                        "mutated": f"{event} in {values[column]}: {other}"})

    def result(self):
        out, last = [b'#include "tests/mutation/mutant.hpp"\n#line 1 "%s"\n' % self.name.encode()], 0
        for position, *_, text in sorted(self.inserts):
            out += [self.text[last:position], text.encode()]
            last = position
        return b"".join(out + [self.text[last:]])


class Walk:
    """Visits one source's tree and books what may go wrong in it."""

    def __init__(self, file, sources):
        self.file, self.sources = file, sources

    # -- what the tree does not tell and the text does

    def declared_constexpr(self, decl):
        path = decl.extent.start.file
        if path is None:
            return False
        text = self.sources(path.name)
        return b"constexpr" in text[decl.extent.start.offset:decl.location.offset]

    def between(self, left, right):
        raw = self.file.text[left.extent.end.offset:right.extent.start.offset].decode()
        return re.sub(r"/\*.*?\*/|//[^\n]*", "", raw).strip()

    def statement_end(self, node):
        return self.file.text.index(b";", node.extent.end.offset) + 1 if not self.file.slice(node).endswith(";") else node.extent.end.offset

    def parentheses(self, start):
        """The text between the first ( after `start` and its )."""
        text, depth = self.file.text, 0
        left = text.index(b"(", start)
        for i in range(left, len(text)):
            depth += {40: 1, 41: -1}.get(text[i], 0)
            if depth == 0:
                return left + 1, i
        raise ValueError("unbalanced")

    # -- the walk

    def top(self, node):
        for child in node.get_children():
            where = child.location.file
            if where is None or where.name != self.file.name:
                continue
            self.visit(child, "", False)

    def visit(self, node, function, followed, result=None):
        kind = node.kind
        if kind in UNEVALUATED:
            return
        if kind in FUNCTIONS:
            return self.function(node, function)
        if kind == K.VAR_DECL:
            if self.declared_constexpr(node):
                return
            return self.initializer(node, function, result)
        if kind == K.FIELD_DECL:
            if node.is_bitfield():  # its width, which is a type, is all that the tree shows
                return
            return self.initializer(node, self.scope(node), result)
        if kind == K.PARM_DECL:
            return
        if kind == K.LAMBDA_EXPR:  # whatever follows it does not follow what it does
            result, followed = None, False
        if kind == K.CALL_EXPR and node.spelling == "keeps":
            return
        if kind.is_expression():
            self.expression(node, function)
        if kind == K.BINARY_OPERATOR:
            kids = list(node.get_children())
            if len(kids) == 2 and self.rule(self.between(*kids), self.file.slice(kids[1])) == "decides":
                return  # whatever is on its left
        if kind == K.IF_STMT:
            return self.branch(node, function, followed, result)
        if kind == K.SWITCH_STMT:
            self.switch(node, function)
        if kind == K.WHILE_STMT:
            self.condition(*self.parentheses(node.extent.start.offset), function)
        if kind == K.RETURN_STMT:
            self.returned(node, function, result)
        self.children(node, function, followed, result)

    def scope(self, node):
        names = []
        parent = node.semantic_parent
        while parent is not None and parent.kind in (K.STRUCT_DECL, K.CLASS_DECL, K.CLASS_TEMPLATE):
            names.insert(0, parent.spelling)
            parent = parent.semantic_parent
        return "::".join(names)

    def function(self, node, outer):
        body = [c for c in node.get_children() if c.kind == K.COMPOUND_STMT]
        if not body:
            return
        if "consteval" in self.file.text[node.extent.start.offset:node.location.offset].decode():
            return
        scope = self.scope(node)
        name = f"{scope}::{node.spelling}" if scope else node.spelling
        result = node.result_type.get_canonical().kind
        for child in node.get_children():
            if child.kind.is_expression():  # a constructor's member initializers
                self.visit(child, name, False)
        self.visit(body[0], name, False, result)

    def initializer(self, node, function, result):
        """Only what stands behind the name; before it are the type and its arguments."""
        for child in node.get_children():
            if child.extent.start.offset > node.location.offset and child.kind.is_expression():
                self.visit(child, function, True, result)

    def children(self, node, function, followed, result):
        kids = list(node.get_children())
        if node.kind == K.CASE_STMT:
            kids = kids[1:]
        for i, child in enumerate(kids):
            later = followed or (node.kind == K.COMPOUND_STMT and i + 1 < len(kids))
            is_statement = node.kind in (K.COMPOUND_STMT, K.CASE_STMT, K.DEFAULT_STMT) or (
                node.kind in (K.FOR_STMT, K.WHILE_STMT, K.CXX_FOR_RANGE_STMT) and i + 1 == len(kids))
            if is_statement:
                self.statement(child, function, later, kids[i + 1] if i + 1 < len(kids) else None, result)
            self.visit(child, function, later, result)

    def statement(self, node, function, followed, following, result):
        """Books the deletion of a statement, where the rest still compiles and differs."""
        kind = node.kind
        if kind == K.RETURN_STMT:
            gives = any(True for _ in node.get_children())
            if not followed and (result != T.VOID or not gives):
                return
        elif kind in (K.BREAK_STMT, K.CONTINUE_STMT):
            if not followed and kind == K.BREAK_STMT:
                return
        elif not kind.is_expression():
            return
        if following is not None and kind in (K.RETURN_STMT, K.BREAK_STMT):
            rest = self.file.slice(following)
            if re.sub(r"^\s*(default|case [^:]*(::\w+)*)\s*:\s*", "", rest).strip(" ;\n") == self.file.slice(node).strip(" ;\n"):
                return
        self.file.delete(node.extent.start.offset, self.statement_end(node), function)

    def branch(self, node, function, followed, result):
        start = node.extent.start.offset
        left, right = self.parentheses(start)
        decided_by_compiler = b"constexpr" in self.file.text[start:left]
        for child in node.get_children():
            at = child.extent.start.offset
            if at < right:
                if not decided_by_compiler:
                    self.visit(child, function, followed, result)
            else:
                if not decided_by_compiler:
                    self.statement(child, function, followed, None, result)
                self.visit(child, function, followed, result)
        if not decided_by_compiler:
            self.condition(left, right, function)

    def condition(self, left, right, function):
        """Negates a condition that is no comparison: those have mutants of their own."""
        text = self.file.text[left:right].decode()
        if ";" in text:
            left += text.rindex(";") + 1
            text = self.file.text[left:right].decode()
        declared = re.match(r"\s*(?:const )?[\w:<>]+\s*(?:const )?[*&]?\s*(\w+) = ", text)
        if declared:
            name = declared.group(1)
            mutant = self.file.note(left, right, f"{text}; !{name}", "negate condition", function)
            self.file.inserts.append((right, -1, 0, 0, f";({MUTANT % mutant}?!{name}:static_cast<bool>({name}))"))
            return
        if re.search(r"[<>=!]=| [<>] |&&|\|\|", text) or text.strip().startswith("!"):
            return
        self.file.mutate_range(left, right, [f"!({text})"], "negate condition", function, "static_cast<bool>(%s)")

    def switch(self, node, function):
        """A label that is overlooked: its value goes where no label is."""
        left, right = self.parentheses(node.extent.start.offset)
        labels = []
        for statement in node.walk_preorder():
            if statement.kind == K.CASE_STMT:
                labels.append(next(statement.get_children()))
        body = ""
        for label in labels:
            at = label.extent
            mutant = self.file.note(at.start.offset, at.end.offset, "/* nothing */", "overlook case", function)
            body += f"if({MUTANT % mutant}&&v==({self.file.slice(label)}))return static_cast<decltype(v)>(0xEE);"
        self.file.inserts.append((left, 0, -right, 0, "[](auto v){" + body + "return v;}("))
        self.file.inserts.append((right, -1, -left, 0, ")"))

    def returned(self, node, function, result):
        value = list(node.get_children())
        if result != T.BOOL or not value or self.file.slice(value[0]) in ("true", "false"):
            return
        self.file.mutate(value[0], ["true", "false"], "return", function, "static_cast<bool>(%s)")

    # -- expressions

    def expression(self, node, function):
        kind = node.kind
        kids = list(node.get_children())
        if kind in (K.BINARY_OPERATOR, K.COMPOUND_ASSIGNMENT_OPERATOR) and len(kids) == 2:
            self.binary(node, kids[0], kids[1], self.between(*kids), function)
        elif kind in (K.CALL_EXPR, K.UNEXPOSED_EXPR) and len(kids) in (2, 3) and self.between(kids[0], kids[-1]) in ("==", "!="):
            self.binary(node, kids[0], kids[-1], self.between(kids[0], kids[-1]), function)
        elif kind == K.UNARY_OPERATOR and len(kids) == 1:
            self.unary(node, kids[0], function)
        elif kind == K.INTEGER_LITERAL:
            self.integer(node, function)
        elif kind == K.CXX_BOOL_LITERAL_EXPR:
            self.file.mutate(node, ["false" if self.file.slice(node) == "true" else "true"], "boolean", function)
        elif kind == K.DECL_REF_EXPR:
            self.reference(node, function)
        elif kind == K.CONDITIONAL_OPERATOR:
            self.ternary(kids[0], function)
        elif kind == K.CALL_EXPR:
            self.call(node, function)

    def binary(self, node, left, right, operator, function):
        a, b = self.file.slice(left), self.file.slice(right)
        both = lambda choices: [f"{a} {other} {b}" for other in choices]
        if operator in COMPARISONS:
            self.file.mutate(node, both(COMPARISONS[operator]), "comparison", function)
        elif operator in ("&&", "||"):
            other = "||" if operator == "&&" else "&&"
            choices = [f"({a}) {other} ({b})"]
            rule = self.rule(operator, b)
            if rule != "decides":
                choices.append(f"static_cast<bool>({b})")
            if rule != "says nothing":
                choices.append(f"static_cast<bool>({a})")
            self.file.mutate(node, choices, "logical", function)
        elif operator in ARITHMETIC and T.POINTER not in (left.type.get_canonical().kind, right.type.get_canonical().kind):
            self.file.mutate(node, both(ARITHMETIC[operator]), "arithmetic", function)
        elif operator in BITWISE:
            self.file.mutate(node, both(BITWISE[operator]), "bitwise", function)
        elif operator in ASSIGNMENTS:
            self.file.mutate(node, both(ASSIGNMENTS[operator]), "assignment", function)

    @staticmethod
    def rule(operator, right):
        """firmware_sim/core/rules.hpp: here every rule is kept. So `a && keeps` and `a || !keeps` are a, the right one says
        nothing; and it decides `a && !keeps` and `a || keeps`, whatever a is."""
        kept = re.fullmatch(r"(!?)keeps\([\w:]+\)", right)
        if kept is None or operator not in ("&&", "||"):
            return ""
        return "says nothing" if (operator == "&&") == (kept.group(1) == "") else "decides"

    def unary(self, node, operand, function):
        text, a = self.file.slice(node), self.file.slice(operand)
        if text.startswith("++"):
            self.file.mutate(node, ["--" + a], "increment", function)
        elif text.startswith("--"):
            self.file.mutate(node, ["++" + a], "increment", function)
        elif text.endswith("++"):
            self.file.mutate(node, [a + "--"], "increment", function)
        elif text.endswith("--"):
            self.file.mutate(node, [a + "++"], "increment", function)
        elif text.startswith("!") and not text.startswith("!="):
            self.file.mutate(node, [f"static_cast<bool>({a})"], "logical", function)
        elif text[0] in "-~":
            self.file.mutate(node, [a], "negation", function)

    def integer(self, node, function):
        text = self.file.slice(node)
        digits = re.sub(r"[uUlL]+$", "", text.replace("'", ""))
        if not re.match(r"0[xX][0-9a-fA-F]+$|[0-9]+$", digits):
            return
        value = int(digits, 0) if digits[:2].lower() == "0x" else int(digits)
        if value == 0:
            choices = [f"{text} + 1"]
        elif value >= 10000 and digits[:2].lower() != "0x":  # a scale: one more is lost in the division
            choices = [f"{text} / 2", f"{text} / 10 * 11"]
        else:
            choices = [f"{text} + 1", f"{text} - 1"]
        self.file.mutate(node, choices, "boundary", function)

    def reference(self, node, function):
        decl = node.referenced
        if decl is None:
            return
        text = self.file.slice(node)
        if decl.kind == K.ENUM_CONSTANT_DECL:
            names = [c.spelling for c in decl.semantic_parent.get_children() if c.kind == K.ENUM_CONSTANT_DECL]
            if len(names) > 1 and decl.spelling in names and text.endswith(decl.spelling):
                other = names[(names.index(decl.spelling) + 1) % len(names)]
                self.file.mutate(node, [text[:len(text) - len(decl.spelling)] + other], "enumerator", function)
        elif decl.kind == K.VAR_DECL and self.declared_constexpr(decl) and decl.type.get_canonical().kind in INTEGERS:
            plain = f"static_cast<::pinjaw::mutation::Plain<decltype({text})>>({text} %s 1)"
            key = (node.extent.start.offset, node.extent.end.offset, "constant")
            if key in self.file.done:
                return
            self.file.done.add(key)
            start, end = key[:2]
            choices = [(self.file.note(start, end, f"{text} {sign} 1", "constant", function), plain % sign) for sign in "+-"]
            self.file.wrap(start, end, choices)

    def ternary(self, condition, function):
        text = self.file.slice(condition)
        if re.search(r"[<>=!]=| [<>] |&&|\|\|", text) or text.startswith("!"):
            return
        self.file.mutate(condition, [f"!({text})"], "negate condition", function, "static_cast<bool>(%s)")

    def call(self, node, function):
        text = self.file.slice(node)
        least_or_most = re.match(r"std::(min|max)\b", text)
        if least_or_most:
            other = "max" if least_or_most.group(1) == "min" else "min"
            self.file.mutate(node, ["std::" + other + text[8:]], "least and most", function)
        clamp = re.match(r"std::clamp(<[\w:]+>)?\(", text)
        arguments = list(node.get_arguments())
        if clamp and len(arguments) == 3:
            kind = clamp.group(1) or ""
            value, low, high = (self.file.slice(a) for a in arguments)
            self.file.mutate(node, [f"std::min{kind}({value}, {high})", f"std::max{kind}({value}, {low})"], "least and most", function)


def main():
    root, out = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    os.chdir(root)
    cache = {}

    def sources(name):
        if name not in cache:
            cache[name] = Path(name).read_bytes()
        return cache[name]

    book, files = [], []
    index = clang.Index.create()
    for folder in FOLDERS:
        for path in sorted((root / folder).glob("*.[ch]pp")):
            name = str(path.relative_to(root))
            unit = index.parse(name, args=["-x", "c++", "-std=c++20", "-I."])
            errors = [str(d) for d in unit.diagnostics if d.severity >= clang.Diagnostic.Error]
            if errors:
                sys.exit("instrument.py: " + name + " does not parse:\n" + "\n".join(errors))
            file = File(root, name, book)
            Walk(file, sources).top(unit.cursor)
            files.append(file)
    if len(book) >= TABLE:
        sys.exit("instrument.py: more mutants than ids")
    for file in files:
        if file.name.endswith("/state_table.cpp"):
            file.table()
        target = out / "tree" / file.name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(file.result())
    (out / "mutants.json").write_text(json.dumps(book, indent=0))
    families = {}
    for mutant in book:
        families[mutant["family"]] = families.get(mutant["family"], 0) + 1
    print(len(book), "mutants:", ", ".join(f"{count} {name}" for name, count in sorted(families.items())))


if __name__ == "__main__":
    main()
