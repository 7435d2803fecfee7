/** What a hot change has changed. */
import { Button } from '@mantine/core'
import { Dialog } from '../../components/Dialog'
import type { Commands } from './useCommands'

export function ChangeReport({ commands }: { commands: Commands }) {
  const { report, forgetReport } = commands
  return (
    <Dialog isOpen={report !== undefined} onClose={forgetReport} title="The run continues with the current file">
      {report?.length === 0 && <p>The file means the same as before.</p>}
      <ul className="change-report">
        {report?.map((line) => (
          <li key={line}>{line}</li>
        ))}
      </ul>
      <p className="quiet">
        Nodes that are active keep the parameters they were entered with. Transitions, conditions and autonomy are those of the file at
        once.
      </p>
      {/* oxlint-disable-next-line jsx-a11y/no-autofocus -- the only control of a modal dialog */}
      <Button onClick={forgetReport} autoFocus>
        Understood
      </Button>
    </Dialog>
  )
}
