"""How the named parts of a made body become roles, parts of its surface and a plan, as of real files in labels.py."""
import numpy as np

from vocabulary import PART, ROLE

BODY = ('trunk', 'neck', 'head', 'tail', 'leg', 'arm', 'wing', 'fin')   # kinds whose joints count in J2J


def limb_role(part, legs, arms):
    """fore, hind, mida.. of a leg or arm; None for further ones"""
    if part['kind'] == 'arm':
        return 'fore' if part['pair'] == 0 else None
    if part['pair'] == legs - 1:
        return 'hind'
    k = part['pair'] + (0 if arms else -1)
    return 'fore' if k < 0 else ('mida', 'midb', 'midc')[k] if k < 3 else None


def along(J, chain, n):
    """n places at equal shares of a chain's length, as (joint, next joint, share)"""
    if len(chain) == 1:
        return [(chain[0], chain[0], 0.0)]
    d = np.array([np.linalg.norm(J[b] - J[a]) for a, b in zip(chain, chain[1:])]) + 1e-9
    c = np.r_[0, np.cumsum(d)] / d.sum()
    out = []
    for t in np.linspace(0, 1, n):
        k = int(np.clip(np.searchsorted(c, t) - 1, 0, len(d) - 1))
        out.append((chain[k], chain[k + 1], float((t - c[k]) / (c[k + 1] - c[k]))))
    return out


def read(parts, names, J):
    """roles {role: (joint, joint, share)}, part of each joint, which joints count, plan facts"""
    at = {n: i for i, n in enumerate(names)}
    roles, label, count = {}, np.zeros(len(names), int), np.zeros(len(names), bool)
    legs = len({p['pair'] for p in parts if p['kind'] == 'leg'})
    arms = any(p['kind'] == 'arm' for p in parts)
    for p in parts:
        j = [at[n] for n in p['joints'] if n in at]
        if not j:
            continue
        s = {'left': '.L', 'right': '.R'}.get(p['side'], '')
        k = p['kind']
        if k in BODY:
            count[j] = True
        put = lambda r, x: roles.__setitem__(r, x if isinstance(x, tuple) else (x, x, 0.0))
        land = {q: at[p[q]] for q in ('upper', 'middle', 'hock', 'end', 'toes') if p.get(q) in at}
        if k == 'trunk':
            c = along(J, j, 4)
            for i, x in enumerate(c):
                put('trunk_%d' % (i if len(c) > 1 else 0), x)
            label[j] = PART['trunk']
        elif k == 'tail' and s == '':
            c = along(J, j, 4)
            for i, x in enumerate(c):
                put('tail_%d' % i, x)
            label[j] = PART['tail']
        elif k in ('neck', 'head'):
            if p['pair'] == 0:
                put(k, j[0])
            label[j] = PART[k]
        elif k == 'jaw':
            if p['pair'] == 0 and s == '':
                put('jaw', j[0])
            label[j] = PART['head']
        elif k in ('eye', 'hair'):
            label[j] = PART['head']
        elif k == 'prop':
            label[j] = PART['prop']
        elif s == '':
            continue
        elif k == 'ear':
            if p['pair'] == 0:
                put('ear' + s, j[0])
            label[j] = PART['ear' + s]
        elif k == 'wing':
            if p['pair'] == 0:
                c = along(J, j, 3)
                for i, x in enumerate(c):
                    put('wing_%d%s' % (i, s), x)
            label[j] = PART['wing' + s]
        elif k == 'fin':
            label[j] = PART['fin' + s]
            if p['pair'] == 0:
                put('fin0_0' + s, j[0])
                if len(j) > 1:
                    put('fin0_1' + s, j[-1])
            elif p['pair'] == 1:
                put('fin1_0' + s, j[0])
        elif k in ('leg', 'arm'):
            r = limb_role(p, legs, arms)
            if r is None:
                label[j] = PART['mid' + s]
                continue
            if r.startswith('mid'):
                label[j] = PART['mid' + s]
                for q in ('upper', 'middle', 'end'):
                    if q in land:
                        put(r + '_' + q + s, land[q])
                continue
            if 'upper' not in land:
                land['upper'] = j[0]
            for q, x in land.items():
                if r + '_' + q + '.L' in ROLE:
                    put(r + '_' + q + s, x)
            if r == 'fore' and j[0] != land['upper']:
                put('fore_base' + s, j[0])
            seg = 'upper'
            for x in j:
                if x in (land.get('middle'), land.get('hock')):
                    seg = 'lower'
                if x in (land.get('end'), land.get('toes')):
                    seg = 'end'
                before = 'upper' in land and j.index(x) < j.index(land['upper']) if land['upper'] in j else False
                label[x] = PART['trunk'] if before else PART['%s_%s%s' % (r, seg, s)]
        if k == 'finger' and s:
            label[j] = PART['fore_end' + s]
            for i, x in enumerate(j[:3]):
                if p['pair'] < 5:
                    put('finger_%d_%d%s' % (p['pair'] + 1, i, s), x)
    return roles, label, count


def plan_of(parts, roles, J):
    n = lambda k: len({p['pair'] for p in parts if p['kind'] == k and p['side'] != 'center'})
    legs, arms, wings, fins = n('leg'), n('arm'), n('wing'), n('fin')
    tail = any(p['kind'] == 'tail' for p in parts)
    place = lambda r: (1 - roles[r][2]) * J[roles[r][0]] + roles[r][2] * J[roles[r][1]]
    ends = [r for r in ('trunk_0', 'head', 'neck', 'trunk_3') if r in roles]
    lean = 0.0
    if len(ends) > 1:
        d = place(ends[1]) - place(ends[0])
        lean = float(d[1] / max(np.linalg.norm(d), 1e-9))          # 1: the trunk stands, 0: it lies
    if legs >= 3:
        return 'many', lean
    if legs == 2:
        return ('winged_four' if wings else 'four'), lean
    if legs == 1:
        if wings and not arms:
            return 'bird', lean
        if tail and lean < 0.7 and not wings:
            return 'dinosaur', lean
        return 'upright', lean
    if fins:
        return 'swims', lean
    if arms:
        return 'upright', lean
    if wings:
        return 'bird', lean
    chain = [p for p in parts if p['kind'] in ('trunk', 'tail', 'neck')]
    if sum(len(p['joints']) for p in chain) >= 5:
        return 'crawls', lean
    return 'none', lean
