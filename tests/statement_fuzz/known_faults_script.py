"""The known faults as a proof script; each claim is to stay open or to be refuted."""

from lyapcheck.claims import Proof
from tests.statement_fuzz.known_faults import FAULTS

proof = Proof("known-faults", "Statements that are false or undefined")
for number, fault in enumerate(FAULTS):
    proof.add(f"F{number}", fault.name, fault.statement)
