/** All keys of the run view, and the switch for those who speak to their computer. */
import { Switch } from '@mantine/core'
import { Dialog } from '../../components/Dialog'
import { TourButton } from '../../components/TourButton'
import { SHORTCUTS } from '../../document/shortcuts'

export interface ShortcutSheetProps {
  readonly isOpen: boolean
  readonly onClose: () => void
  readonly areOn: boolean
  readonly onSwitch: (on: boolean) => void
}

export function ShortcutSheet({ isOpen, onClose, areOn, onSwitch }: ShortcutSheetProps) {
  return (
    <Dialog isOpen={isOpen} onClose={onClose} title="Keyboard">
      <dl className="shortcuts">
        {SHORTCUTS.map(({ key, words }) => (
          <div key={key}>
            <dt>
              <kbd>{key}</kbd>
            </dt>
            <dd>{words}</dd>
          </div>
        ))}
      </dl>
      <p className="quiet">In the outline, arrow keys move and Enter chooses. Keys do nothing while you write in a field.</p>
      <TourButton onOpened={onClose} />
      <Switch label="Single keys are commands" checked={areOn} onChange={(event) => onSwitch(event.currentTarget.checked)} />
    </Dialog>
  )
}
