/** The way into the tour, wherever help is offered. */
import { IconRoute } from '@tabler/icons-react'
import { useLive } from '../api/live'
import { openTour, useTour } from '../api/tour'
import { CommandButton } from './CommandButton'

export function TourButton({ onOpened }: { readonly onOpened?: (() => void) | undefined }) {
  const hasBegun = useTour((s) => s.step > 0)
  const mayDo = useLive((s) => s.role === 'operator')
  if (!mayDo) return null
  return (
    <CommandButton
      label={hasBegun ? 'Go on with the tour' : 'Tour'}
      hint="Build a behavior of two states and run it; you do every step yourself"
      icon={<IconRoute size={15} aria-hidden />}
      onPress={() => {
        onOpened?.()
        openTour()
      }}
    />
  )
}
