/** Stops everything in the cell at once; in words what it is not. */
import { IconHandStop } from '@tabler/icons-react'
import { useState } from 'react'
import { api, wordsOf } from '../../api/client'
import { useLive } from '../../api/live'
import { CommandButton } from '../../components/CommandButton'

export function StopCell() {
  const [said, setSaid] = useState('')
  const isConnected = useLive((s) => s.connection === 'live')
  return (
    <>
      {said && (
        <span role="status" className="quiet">
          {said}
        </span>
      )}
      <CommandButton
        label="Stop the cell"
        tone="danger"
        icon={<IconHandStop size={15} aria-hidden />}
        hint="Stops every run and every goal; the arms decelerate to rest. This is no emergency stop: press the button at the cell where people are in danger"
        obstacle={isConnected ? undefined : 'the server does not answer. Where there is danger, press the button at the cell'}
        onPress={() => {
          setSaid('Stopping')
          api.stopCell().then(
            () => setSaid('Everything is at rest'),
            (error: unknown) => setSaid(wordsOf(error)),
          )
        }}
      />
    </>
  )
}
