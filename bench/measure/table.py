"""Tables in Markdown."""


def markdown(heading, rows):
    lines = ['| ' + ' | '.join(heading) + ' |', '|' + ' --- |' * len(heading)]
    lines += ['| ' + ' | '.join(map(str, row)) + ' |' for row in rows]
    return '\n'.join(lines) + '\n'


def millions(number):
    return f'{number * 1e-6:.2f}'
