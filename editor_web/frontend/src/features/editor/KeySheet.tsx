/** All keys of the editor. */
import { Dialog } from '../../components/Dialog'
import { TourButton } from '../../components/TourButton'
import { chordText } from '../../document/editing/keys'
import { COMMANDS } from './commands'
import { setEditor, useEditor } from './store'

const PARTS = ['Document', 'Build', 'Arrange', 'Move around'] as const

export function KeySheet() {
  const isShown = useEditor((s) => s.isSheetShown)
  return (
    <Dialog isOpen={isShown} onClose={() => setEditor({ isSheetShown: false })} title="Keyboard">
      <div className="key-sheet">
        {PARTS.map((part) => (
          <section key={part} aria-label={part}>
            <h3>{part}</h3>
            <dl className="shortcuts">
              {COMMANDS.filter((command) => command.part === part && command.chords.length > 0).map((command) => (
                <div key={command.id}>
                  <dt>
                    {command.chords.map((chord) => (
                      <kbd key={chordText(chord)}>{chordText(chord)}</kbd>
                    ))}
                  </dt>
                  <dd>{command.words}</dd>
                </div>
              ))}
            </dl>
          </section>
        ))}
      </div>
      <p className="quiet">
        Arrow keys go from node to node, Tab through all of them. Commands without a key are in the palette (Ctrl+K). Keys do nothing while
        you write in a field; out of the text leads Esc, then Tab.
      </p>
      <TourButton onOpened={() => setEditor({ isSheetShown: false })} />
    </Dialog>
  )
}
