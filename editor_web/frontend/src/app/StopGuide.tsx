/** The recovery guide beside the page, with the jog panel and the enabling of real devices in it. */

import { WhileLoading, lazyView } from '../components/lazyView'
import { RecoveryGuide } from '../features/stop/RecoveryGuide'
import { behaviorHref, runHref, TEACH_HREF } from './route'

const JogHere = lazyView(async () => (await import('./JogHere')).JogHere)

const EnableHere = lazyView(async () => (await import('./EnableHere')).EnableHere)

export function StopGuide({ onOpen }: { readonly onOpen: (href: string) => void }) {
  return (
    <RecoveryGuide
      renderJog={(arm) => (
        <WhileLoading value={<div role="status" aria-label="Loading" />}>
          <JogHere key={arm} arm={arm} />
        </WhileLoading>
      )}
      renderEnable={(device) => (
        <WhileLoading value={null}>
          <EnableHere device={device} />
        </WhileLoading>
      )}
      onTeach={() => onOpen(TEACH_HREF)}
      onRun={(id) => onOpen(runHref(id))}
      onBehavior={(id) => onOpen(behaviorHref(id))}
    />
  )
}
