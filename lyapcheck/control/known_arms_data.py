"""Written by ``python -m lyapcheck.control.write_known_arms``: not to be edited."""

from __future__ import annotations

# fmt: off
TYPE_CHECKING = False
if TYPE_CHECKING:
    Texts = tuple[str, ...]
    Arms = dict[str, tuple[int, Texts, tuple[str | None, ...], Texts, str, Texts, Texts]]

ARMS: Arms = {'buap3': (359735764489276700,
           ('base', 'shoulder', 'elbow'),
           ('50', '150', '15'),
           ('0', '1007/25', '181/100'),
           '203/500',
           (),
           ('friction of base = 0.406 N·m·s/rad is assumed, between 0.406 and 2.288 N·m·s/rad: only '
            'λmin(B) = 0.406 is printed; the base is put at the bottom of what the joints are known to '
            'have',
            'friction of shoulder = 2.288 N·m·s/rad is assumed, between 0.406 and 2.288 N·m·s/rad: the '
            'shoulder of the two-joint arm has 2.288; the paper prints only that no joint has less than '
            '0.406',
            'friction of elbow = 0.406 N·m·s/rad is assumed, between 0.406 and 2.288 N·m·s/rad: λmin(B) '
            '= 0.406 is printed, its joint is not: the smallest motor is taken to have the least '
            'friction')),
 'buap3-small': (1650385562797457164,
                 ('base', 'shoulder', 'elbow'),
                 ('15', '50', '4'),
                 ('0', '414/25', '57/25'),
                 '3/100',
                 (),
                 ('friction of base = 0.175 N·m·s/rad is assumed, between 0.05 and 0.5 N·m·s/rad: not '
                  'printed; the motor of 15 N·m of the two-joint arm has 0.175',
                  'friction of shoulder = 0.7 N·m·s/rad is assumed, between 0.2 and 2.288 N·m·s/rad: not '
                  'printed; between the motors of 15 and 150 N·m of the two-joint arm, which have 0.175 '
                  'and 2.288',
                  'friction of elbow = 0.1 N·m·s/rad is assumed, between 0.03 and 0.2 N·m·s/rad: not '
                  'printed; the motor is smaller than that of 15 N·m of the two-joint arm, which has '
                  '0.175')),
 'pelican2': (163998737302347788,
              ('shoulder', 'elbow'),
              (None, None),
              ('119674011717/10000000000', '2297934621/5000000000'),
              '1/50',
              (),
              ('friction of shoulder = 0.2 N·m·s/rad is assumed, between 0.05 and 1 N·m·s/rad: no '
               'friction of this arm is published; a direct-drive motor of this size has a few tenths',
               'friction of elbow = 0.1 N·m·s/rad is assumed, between 0.02 and 0.5 N·m·s/rad: no '
               "friction of this arm is published; taken as half of the shoulder's")),
 'pendulum1': (1638502733290908662,
               ('pivot',),
               ('10',),
               ('981/100',),
               '1/10',
               ('torque limit of pivot = 10 N·m is assumed: just above the largest gravity torque of the '
                'heaviest mass, 9.81 N·m',),
               ('friction of pivot = 0.5 N·m·s/rad is assumed, between 0.1 and 1 N·m·s/rad: chosen so '
                'that the pendulum is visibly damped',)),
 'reyes-kelly2': (736975888052219378,
                  ('shoulder', 'elbow'),
                  ('150', '15'),
                  ('4211433/100000', '91233/25000'),
                  '7/40',
                  (),
                  ())}
