/** A behavior that is written for another cell: why it cannot be started here, and the way to a copy that can. */
import { Button } from '@mantine/core'
import { IconArrowsExchange, IconInfoCircle } from '@tabler/icons-react'
import { useState } from 'react'
import { Dialog } from '../../components/Dialog'
import { WhileLoading, lazyView } from '../../components/lazyView'
import { Notice } from '../../components/Notice'
import { Words } from '../../components/Words'

const Adaptation = lazyView(async () => (await import('./Adaptation')).Adaptation)

export interface AdaptHereProps {
  readonly behavior: string
  readonly obstacle: string
  readonly mayEdit: boolean
  readonly onMade: (id: string) => void
}

export function AdaptHere({ behavior, obstacle, mayEdit, onMade }: AdaptHereProps) {
  const [isOpen, setOpen] = useState(false)
  if (obstacle === '') return null
  const tools = mayEdit && (
    <Button size="compact-sm" variant="default" leftSection={<IconArrowsExchange size={14} aria-hidden />} onClick={() => setOpen(true)}>
      Adapt…
    </Button>
  )
  return (
    <>
      <Notice icon={<IconInfoCircle size={16} aria-hidden />} tools={tools}>
        It cannot be started here: <Words text={obstacle} />
      </Notice>
      <Dialog isOpen={isOpen} isWide title="Adapt to this cell" onClose={() => setOpen(false)}>
        <WhileLoading value={<div role="status" aria-label="Loading" />}>
          <Adaptation
            behavior={behavior}
            onMade={(id) => {
              setOpen(false)
              onMade(id)
            }}
          />
        </WhileLoading>
      </Dialog>
    </>
  )
}
