"""Reads loops of plugins from their disassembly."""
import re
import subprocess

# Packed or scalar, p or s; a fused multiply-add has three digits.
ARITHMETIC = re.compile(r'v?(?:add|sub|mul|div|sqrt|min|max|(fn?m(?:add|sub)\d{3}))([ps])([sd])$')
REGISTER = re.compile(r'%([xyz]mm)\d')
BYTES = {'xmm': 16, 'ymm': 32, 'zmm': 64}


def functions(objdump, file, *names):
    """Full name → instructions as text, of the functions whose names contain one of `names`."""
    listing = subprocess.run([objdump, '-d', '-C', '--no-show-raw-insn', file], capture_output=True, text=True, check=True)
    found, current = {}, None
    for line in listing.stdout.splitlines():
        if line.endswith('>:'):
            whole = line.split('<', 1)[1]
            current = found.setdefault(whole, []) if any(name in whole for name in names) else None
        elif current is not None and (code := line.split('\t')[1:]):
            current.append(code[0])
    return found


def flops(instructions, lanes):
    """Arithmetic of one lane: a packed instruction counts once per number of its register, a fused multiply-add twice; a
    loop evaluates `lanes` at a time."""
    total = 0
    for code in instructions:
        if match := ARITHMETIC.match(code.split()[0]):
            fused, packed, kind = match.groups()
            numbers = BYTES[max(REGISTER.findall(code), default='xmm')] // (8 if kind == 'd' else 4) if packed == 'p' else 1
            total += numbers * (2 if fused else 1)
    return total / lanes
