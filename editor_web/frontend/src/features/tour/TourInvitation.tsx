/** On the first page, for whoever has not been through the tour. */
import { leaveTour, useTour } from '../../api/tour'
import { CommandButton } from '../../components/CommandButton'
import { TourButton } from '../../components/TourButton'

export function TourInvitation() {
  const isSettled = useTour((s) => s.isSettled)
  if (isSettled) return null
  return (
    <section className="tour-invitation" aria-label="First steps">
      <div>
        <strong>New here?</strong> Build a behavior of two states and run it. It takes two minutes, and you do every step yourself.
      </div>
      <div className="command-row">
        <TourButton />
        <CommandButton label="Not now" tone="quiet" onPress={leaveTour} />
      </div>
    </section>
  )
}
