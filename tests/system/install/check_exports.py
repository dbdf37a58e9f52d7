#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what a shared library of cadt exports: of C++, functions and classes directly in the namespace cadt, with what
the compiler adds to these classes; of C, the functions that c_symbols.txt lists. So no kernel, no function of a back end
and no template of the standard library, which another library in the process would then share.

usage: check_exports.py NM LIBCADT.SO
       check_exports.py --self-test"""
import re
import subprocess
import sys
from pathlib import Path

C_SYMBOLS = Path(__file__).parent / "c_symbols.txt"
# A function, an operator, or a member of a class; namespaces within cadt have names in small letters.
OF_CADT = re.compile(r"cadt::([A-Z]\w*::|[a-z]\w*(\[abi:\w+\])?\(|operator\W+\()")
OF_A_CLASS = re.compile(r"(typeinfo|typeinfo name|vtable) for cadt::[A-Z]\w*")


def exported(nm, library):
    """Pairs of a symbol's type and its demangled name."""
    lines = subprocess.run([nm, "--dynamic", "--defined-only", "--demangle", library], check=True, stdout=subprocess.PIPE,
                           text=True).stdout.splitlines()
    return [tuple(line.split(maxsplit=2)[1:]) for line in lines]


def listed(text):
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def problems_of(symbols, c_symbols):
    problems, of_c = [], set()
    if ("T", "cadt::to_string(cadt::Backend)") not in symbols:
        problems.append("cadt::to_string(cadt::Backend) is not exported, or nm's output was not understood")
    for kind, name in symbols:
        if re.fullmatch(r"\w+", name):  # C, or a kernel
            of_c.add(name)
        elif not (OF_CADT.match(name) if kind == "T" else kind == "V" and OF_A_CLASS.fullmatch(name)):
            problems.append(f"exported, but not of the interface: {kind} {name}")
    for name in sorted(of_c - set(c_symbols)):
        wrong = "" if re.fullmatch(r"cadt_[a-z0-9_]+", name) else ", and is no name of cadt's"
        problems.append(f"exported, but not in {C_SYMBOLS.name}: {name}{wrong}")
    problems += [f"in {C_SYMBOLS.name}, but not exported: {name}" for name in c_symbols if name not in of_c]
    if c_symbols != sorted(set(c_symbols)):
        problems.append(f"{C_SYMBOLS.name} is not sorted, or has a name twice")
    return problems


def self_test():
    right = [("T", "cadt::to_string(cadt::Backend)"), ("T", "cadt::Hash128::to_string[abi:cxx11]() const"),
             ("T", "cadt::Triangulator::~Triangulator()"), ("T", "cadt::operator==(cadt::Error const&, cadt::Error const&)"),
             ("V", "typeinfo name for cadt::Error"), ("V", "vtable for cadt::Error"), ("T", "cadt_version")]
    wrong = [("T", "cadt::host::launch(int)"), ("W", "std::vector<cadt::Error>::push_back(cadt::Error const&)"),
             ("V", "typeinfo for std::bad_variant_access"), ("u", "std::_Sp_make_shared_tag::_S_ti()::__tag"),
             ("T", "cadt_kernel_import"), ("T", "main"), ("V", "vtable for cadt::opencl::Device"),
             ("W", "cadt::Triangulation::hull() const"), ("B", "cadt::most_devices")]
    assert problems_of(right, ["cadt_version"]) == [], problems_of(right, ["cadt_version"])
    for symbol in wrong:
        assert len(problems_of([*right, symbol], ["cadt_version"])) == 1, symbol
    for c_symbols in ([], ["cadt_gone", "cadt_version"], ["cadt_version", "cadt_version"]):
        assert len(problems_of(right, c_symbols)) == 1, c_symbols
    assert len(problems_of(right[1:], ["cadt_version"])) == 1
    assert listed("# a\n\ncadt_a\ncadt_b\n") == ["cadt_a", "cadt_b"]


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    problems = problems_of(exported(*sys.argv[1:]), listed(C_SYMBOLS.read_text()))
    print("\n".join(problems) or f"{sys.argv[2]}: the interface alone is exported")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
