#!/usr/bin/env python3
"""Promises: LINT.

Seeds small faults and requires that each is caught by the rule that is trusted with it; a clean twin must pass.

usage: seeded_faults.py warnings CXX         compiler warnings of cmake/pinjaw.cmake
       seeded_faults.py architecture PROGRAM the tests of tests/architecture, over a copy of the tree
       seeded_faults.py tools CPPCHECK_OPTION...  clang-tidy with .clang-tidy, cppcheck, clang-format, shellcheck
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# flag: a source that only it objects to
WARNINGS = {
    "conversion": "unsigned char low(int n) { return n; }",
    "shadow": "int twice(int n) { int sum = n; { int n = 2; sum += n; } return sum; }",
    "old-style-cast": "int whole(double d) { return (int)d; }",
    "non-virtual-dtor": "struct Base { virtual void f(); }; ",
    "unused-parameter": "int zero(int n) { return 0; }",
    "unused-variable": "int one() { int idle = 3; return 1; }",
    "return-type": "int none() { }",
    "switch": "enum class Light { Red, Green }; int f(Light l) { switch (l) { case Light::Red: return 1; } return 0; }",
    "sign-compare": "bool less(int a, unsigned b) { return a < b; }",
    "parentheses": "bool odd(int a) { if (a = 1) return true; return false; }",
    "implicit-fallthrough": "int g(int n) { switch (n) { case 1: n += 1; case 2: return n; default: return 0; } }",
    "pedantic": "int room(int n) { int many[n]; many[0] = n; return many[0]; }",
    "missing-field-initializers": "struct Pair { int a; int b; }; Pair half() { return {1}; }",
}

# rule: a source that it objects to
TIDY = {
    "bugprone-integer-division": "double half(int n) {\n  return n / 2;\n}\n",
    "bugprone-use-after-move": "#include <string>\n#include <utility>\nvoid sink(std::string text);\nstd::size_t twice(std::string text) {\n  sink(std::move(text));\n  return text.size();\n}\n",
    "bugprone-branch-clone": "int sign(int n) {\n  if (n > 0) {\n    return 1;\n  } else {\n    return 1;\n  }\n}\n",
    "bugprone-infinite-loop": "int wait(int n) {\n  int i = 0;\n  while (i < n) {\n  }\n  return i;\n}\n",
    "bugprone-narrowing-conversions": "int add(int sum, double part) {\n  sum += part;\n  return sum;\n}\n",
    "bugprone-sizeof-expression": "struct Box {\n  int* place;\n};\nunsigned long room(const Box& box) {\n  return sizeof(&box);\n}\nunsigned long zero() {\n  return sizeof(sizeof(int));\n}\n",
    "bugprone-macro-parentheses": "#define TWICE(x) x * 2\n",
    "bugprone-suspicious-semicolon": "int f(int n) {\n  if (n > 0);\n  n += 1;\n  return n;\n}\n",
    "bugprone-unhandled-self-assignment": "class Own {\n public:\n  Own& operator=(const Own& other) {\n    delete place_;\n    place_ = new int(*other.place_);\n    return *this;\n  }\n\n private:\n  int* place_ = nullptr;\n};\n",
    "readability-identifier-naming": "int CountPins() {\n  return 1;\n}\n",
    "readability-function-size": "int many(int n) {\n" + "  n += 1;\n" * 61 + "  return n;\n}\n",
    "performance-unnecessary-value-param": "#include <string>\nstd::size_t length(std::string text) {\n  return text.size();\n}\n",
    "performance-for-range-copy": "#include <string>\n#include <vector>\nstd::size_t total(const std::vector<std::string>& all) {\n  std::size_t sum = 0;\n  for (const std::string one : all) sum += one.size();\n  return sum;\n}\n",
    "cppcoreguidelines-init-variables": "int later(bool yes) {\n  int value;\n  if (yes) value = 1;\n  return yes ? value : 0;\n}\n",
    "cppcoreguidelines-pro-type-member-init": "struct Point {\n  Point() {}\n  int x;\n};\n",
    "google-explicit-constructor": "struct Length {\n  Length(int mm) : length_mm(mm) {}\n  int length_mm;\n};\n",
    "modernize-use-nodiscard": "class Counter {\n public:\n  int value() const { return value_; }\n\n private:\n  int value_ = 0;\n};\n",
}

CPPCHECK = {
    "nullPointer": "int f() {\n  int* p = nullptr;\n  return *p;\n}\n",
    "uninitvar": "int f() {\n  int n;\n  return n + 1;\n}\n",
    "arrayIndexOutOfBounds": "int f() {\n  int a[3] = {1, 2, 3};\n  return a[3];\n}\n",
    "zerodiv": "int f() {\n  int zero = 0;\n  return 3 / zero;\n}\n",
    "memleak": "void f() {\n  int* p = new int(3);\n  *p = 4;\n}\n",
    "returnDanglingLifetime": "int* f() {\n  int n = 3;\n  return &n;\n}\n",
    "shiftTooManyBits": "int f(int n) {\n  return n << 40;\n}\n",
    "mismatchAllocDealloc": "void f() {\n  int* p = new int[3];\n  delete p;\n}\n",
    "oppositeInnerCondition": "int f(int n) {\n  if (n > 3) {\n    if (n < 3) return 1;\n  }\n  return 0;\n}\n",
    "invalidContainer": "#include <vector>\nint f(std::vector<int>& v) {\n  auto it = v.begin();\n  v.erase(it);\n  return *it;\n}\n",
    "AssignmentAddressToInteger": "int f(int* p) {\n  int n = p;\n  return n;\n}\n",
}

FORMAT = "int   badly( int n ){return n;}\n"
SHELL = ("SC2086", '#!/usr/bin/env bash\nrm -r $1\n')

NO_FOLDER = "the_page_lists_every_folder_that_holds_code"

# test of tests/architecture: files that it must name
ARCHITECTURE = {
    "every_include_follows_an_arrow": {"protocol/wire/seed_arrow.hpp": '#pragma once\n#include "host/base/diagnostics.hpp"\n',
                                       "firmware_sim/core/seed_arrow.cpp": '#include "firmware_sim/plant/plant.hpp"\n'},
    "portable_code_uses_only_the_listed_standard_headers": {"firmware_sim/core/seed_header.cpp": "#include <vector>\n",
                                                            "protocol/wire/seed_header.hpp": "#include <chrono>\n"},
    "portable_code_has_no_heap_virtual_floating_point_or_static_mutable_data": {
        "firmware_sim/core/seed_heap.cpp": "int* make() { return new int; }\n",
        "firmware_sim/core/seed_double.cpp": "int half(int n) { return static_cast<int>(n * double{0.5}); }\n",
        "firmware_sim/core/seed_float.cpp": "float f;\n",
        "firmware_sim/core/seed_static.cpp": "int next() {\n  static int count = 0;\n  return ++count;\n}\n",
        "protocol/wire/seed_virtual.hpp": "struct Base { virtual int f() = 0; };\n",
        "protocol/wire/seed_throw.hpp": "inline void f() { throw 1; }\n",
        "protocol/wire/seed_thread.hpp": "thread_local int n = 0;\n"},
    "third_party_types_stay_in_the_folder_named_for_them": {"host/model/seed_yaml.cpp": "#include <yaml-cpp/yaml.h>\n",
                                                            "host/base/seed_yaml.hpp": "#include <yaml-cpp/yaml.h>\n"},
    NO_FOLDER: {"protocol/elsewhere/seed_folder.cpp": "\n"},
    "every_test_of_protocol_and_firmware_is_for_one": {"tests/protocol/wire/seed_for_nothing_test.cpp": "// a test\n"},
    "no_source_proves_what_is_not_promised": {"tests/protocol/wire/seed_unpromised_test.cpp": "// Promises: NOWHERE.\n"},
}


def run(*command, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    return done.returncode, done.stdout + done.stderr


class Verdict:
    def __init__(self):
        self.caught, self.missed = 0, []

    def take(self, what, is_caught, output=""):
        if is_caught:
            self.caught += 1
        else:
            self.missed.append(what)
            print(f"missed: {what}\n{output}")

    def end(self, what):
        print(f"{what}: {self.caught} seeded faults caught, {len(self.missed)} missed")
        figures = os.environ.get("PINJAW_FIGURES")
        if figures:
            with open(figures, "a") as out:
                out.write(f'{{"promise": "LINT", "what": "{what}: seeded faults caught", "value": "{self.caught}", "unit": "of {self.caught + len(self.missed)}"}}\n')
        return 1 if self.missed else 0


def warnings(compiler):
    text = (ROOT / "cmake/pinjaw.cmake").read_text()
    flags = re.search(r"target_compile_options\(pinjaw_flags INTERFACE\s+([^)]*)\)", text).group(1).split()
    verdict = Verdict()
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "seed.cpp"
        for flag, code in {**WARNINGS, "": "int fine() { return 1; }"}.items():
            source.write_text(code + "\n")
            status, output = run(compiler, "-std=c++20", "-c", "-o", os.devnull, *flags, source)  # some warnings come with code only
            good = status != 0 and re.search(rf"\[-Werror=({flag}|{flag}=|vla)[\]=]" if flag == "pedantic" else rf"\[-Werror={flag}[\]=]", output) if flag else status == 0
            verdict.take(f"-W{flag}", good, output)
    return verdict.end("compiler warnings")


def architecture(program):
    verdict = Verdict()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in ("protocol", "firmware_sim", "host", "tests", "docs"):
            shutil.copytree(ROOT / part, folder / part, ignore=lambda _, names: [n for n in names if Path(n).suffix not in ("", ".cpp", ".hpp", ".py", ".md", ".pml", ".sh")])
        environment = {**os.environ, "PINJAW_SEEDED_SOURCE_DIR": name}
        environment.pop("PINJAW_FIGURES", None)
        environment.pop("GTEST_OUTPUT", None)
        status, output = run(program, env=environment)
        verdict.take("the tree as it is passes", status == 0, output)
        # a folder of its own for the last: other tests cannot judge a folder that the page does not list
        for tests in (ARCHITECTURE.keys() - {NO_FOLDER}, {NO_FOLDER}):
            seeds = [(test, path, code) for test in tests for path, code in ARCHITECTURE[test].items()]
            for _, path, code in seeds:
                (folder / path).parent.mkdir(parents=True, exist_ok=True)
                (folder / path).write_text(code)
            _, output = run(program, env=environment)
            for test, path, _ in seeds:
                found = re.search(rf"\[ RUN +\] \w+\.{test}$(.*?)\[  FAILED  \] \w+\.{test}", output, re.S | re.M)
                verdict.take(f"{test}: {path}", found and path.removeprefix("tests/") in found.group(1), found.group(1) if found else output)
    return verdict.end("architecture")


def tools(options):
    verdict = Verdict()
    named = [c.strip() for c in re.search(r"Checks: >-\n((?:  .*\n)+)", (ROOT / ".clang-tidy").read_text()).group(1).replace("\n", "").split(",")]
    known = run("clang-tidy", "--checks=*", "--list-checks", cwd="/")[1].split()
    for check in named:
        if not check.startswith("-"):
            verdict.take(f".clang-tidy names {check}, which this clang-tidy has", any(re.fullmatch(check.replace("*", ".*"), k) for k in known))
    with tempfile.TemporaryDirectory() as name:
        source = Path(name) / "seed.cpp"
        for rule, code in TIDY.items():
            source.write_text(code)
            status, output = run("clang-tidy", "--quiet", f"--config-file={ROOT / '.clang-tidy'}", source, "--", "-std=c++20")
            verdict.take(f"clang-tidy {rule}", status != 0 and f"[{rule}" in output, output)
        for rule, code in CPPCHECK.items():
            source.write_text(code)
            status, output = run("cppcheck", *options, "--template={id}", source)
            verdict.take(f"cppcheck {rule}", status != 0 and rule in output.split(), output)
        clean = "int fine(int n) {\n  return n + 1;\n}\n"
        source.write_text(clean)
        verdict.take("clang-tidy: a clean source passes", run("clang-tidy", "--quiet", f"--config-file={ROOT / '.clang-tidy'}", source, "--", "-std=c++20")[0] == 0)
        verdict.take("cppcheck: a clean source passes", run("cppcheck", *options, source)[0] == 0)
        form = f"--style=file:{ROOT / '.clang-format'}"
        verdict.take("clang-format: a clean source passes", run("clang-format", "--dry-run", "-Werror", form, source)[0] == 0)
        source.write_text(FORMAT)
        verdict.take("clang-format", run("clang-format", "--dry-run", "-Werror", form, source)[0] != 0)
        script = Path(name) / "seed"
        script.write_text(SHELL[1])
        status, output = run("shellcheck", script)
        verdict.take(f"shellcheck {SHELL[0]}", status != 0 and SHELL[0] in output, output)
    return verdict.end("linters")


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in ("warnings", "architecture", "tools"):
        sys.exit(__doc__)
    if sys.argv[1] == "tools":
        return tools(sys.argv[2:])
    return {"warnings": warnings, "architecture": architecture}[sys.argv[1]](sys.argv[2])


if __name__ == "__main__":
    sys.exit(main())
